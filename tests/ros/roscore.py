"""ROS 1's master, for peers and for OpenDR's nodes."""

import os
import signal
import socket
import subprocess
import xmlrpc.client

from patience import PATIENCE, wait_until


class Roscore:
    """ROS 1's master at a port of its own; `environment` is what its nodes need."""

    def __init__(self, folder):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        self.uri = f"http://127.0.0.1:{port}/"
        self.environment = {
            "ROS_MASTER_URI": self.uri,
            "ROS_IP": "127.0.0.1",
            "ROS_HOSTNAME": "127.0.0.1",
            "ROS_HOME": str(folder),
            "ROS_LOG_DIR": str(folder),
        }
        self.process = subprocess.Popen(
            ["roscore", "-p", str(port)],
            env={**os.environ, **self.environment},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            start_new_session=True,
        )
        try:
            wait_until(self.answers, PATIENCE, f"roscore at {self.uri}")
        except AssertionError:
            self.close()
            raise

    def answers(self):
        """Whether the master and rosout, which comes last, are there."""
        try:
            _, _, (_, subscribers, _) = xmlrpc.client.ServerProxy(self.uri).getSystemState("/test")
        except OSError:
            return False
        return any(topic == "/rosout" for topic, _ in subscribers)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        for wanted in (signal.SIGINT, signal.SIGKILL):
            try:
                os.killpg(self.process.pid, wanted)
                self.process.wait(15)
                return
            except subprocess.TimeoutExpired:
                continue
            except ProcessLookupError:
                return
