"""A real ROS 1 (Debian's roscore, rospy and tools) and crates/ros1's probe, as processes that exchange lines of JSON."""

import json
import os
import signal
import subprocess
import threading
import time
import xmlrpc.client
from pathlib import Path

import pytest
from patience import free_port, wait_until
from programs import example

ROS = Path(os.environ.get("OPENDR_ROS1_BIN", "/usr/bin"))
PEER = [str(ROS / "python3"), str(Path(__file__).with_name("peer.py"))]
STRING = ("std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1")
IMAGE = ("sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743")
SET_BOOL = ("std_srvs/SetBool", "09fb03525b03e7ea1fd3992bafd87e16")


def pytest_collection_modifyitems(items):
    if not (ROS / "roscore").exists():
        for item in items:
            item.add_marker(pytest.mark.skip(reason="skipped: no roscore; apt-get install ros-core python3-rospy"))


def until(condition, seconds=30, what="it"):
    return wait_until(condition, seconds, what)


class Process:
    """A program whose lines of JSON are collected."""

    def __init__(self, command, environment):
        self.lines, self.other = [], []
        self.process = subprocess.Popen(
            list(map(str, command)), env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self):
        for line in self.process.stdout:
            try:
                self.lines.append(json.loads(line))
            except ValueError:
                self.other.append(line)

    def having(self, key):
        return [line for line in list(self.lines) if key in line]

    def wait_for(self, key, count=1, seconds=30, where=lambda line: True):
        def found():
            lines = [line for line in self.having(key) if where(line)]
            return lines if len(lines) >= count else None

        try:
            return until(found, seconds, f"{count} of {key}")
        except AssertionError as error:
            others = [line for line in self.lines if key not in line]
            raise AssertionError(
                f"{error}: {self.lines[-5:]}, besides {others[-20:]} {''.join(self.other[-20:])}"
            ) from None

    def end(self, seconds=60):
        code = self.process.wait(seconds)
        self.reader.join(5)
        assert code == 0, (self.lines[-5:], self.other[-20:])
        return self

    def kill(self, how=signal.SIGKILL):
        if self.process.poll() is None:
            self.process.send_signal(how)
        self.process.wait(20)

    def memory_kb(self):
        status = Path(f"/proc/{self.process.pid}/status").read_text()
        return int(status.split("VmRSS:")[1].split()[0])

    def peak_kb(self):
        status = Path(f"/proc/{self.process.pid}/status").read_text()
        return int(status.split("VmHWM:")[1].split()[0])


class Ros:
    """A roscore on a port of its own, and programs that belong to it."""

    def __init__(self, home, probe):
        self.port, self.program = free_port(), probe
        kept = {key: value for key, value in os.environ.items() if not key.startswith(("ROS_", "PYTHON", "VIRTUAL"))}
        self.environment = {
            **kept, "ROS_MASTER_URI": f"http://127.0.0.1:{self.port}", "ROS_IP": "127.0.0.1", "ROS_HOME": str(home),
            "PATH": f"{ROS}:/usr/sbin:/bin", "PYTHONUNBUFFERED": "1",
        }
        self.processes = []
        self.start()

    @property
    def master(self):
        return xmlrpc.client.ServerProxy(self.environment["ROS_MASTER_URI"])

    def is_up(self):
        try:
            return self.master.getPid("/test")[0] == 1
        except OSError:
            return False

    def start(self):
        command = [ROS / "roscore", "-p", str(self.port)]
        log = subprocess.DEVNULL
        self.core = subprocess.Popen(command, env=self.environment, stdout=log, stderr=log, start_new_session=True)
        until(self.is_up, 40, "roscore")

    def kill_master(self):
        """The master dies as in a crash; what roscore started beside it ends by itself."""
        os.kill(self.master.getPid("/test")[2], signal.SIGKILL)
        self.core.send_signal(signal.SIGINT)
        self.core.wait(30)

    def run(self, command):
        self.processes.append(Process(command, self.environment))
        return self.processes[-1]

    def probe(self, *words):
        return self.run([*self.program, *words])

    def peer(self, *words):
        return self.run([*PEER, *words])

    def tool(self, *words, seconds=30, code=0):
        done = subprocess.run(
            [str(ROS / words[0]), *map(str, words[1:])], env=self.environment, capture_output=True, text=True,
            timeout=seconds,
        )
        assert code is None or done.returncode == code, done.stdout + done.stderr
        return done.stdout

    def tool_for(self, seconds, *words):
        """Returns the output of a tool that does not end, after some seconds."""
        process = Process([ROS / words[0], *words[1:]], self.environment)
        time.sleep(seconds)
        process.kill(signal.SIGINT)
        process.reader.join(5)
        return "".join(process.other)

    def publishers(self, topic):
        return dict(self.master.getSystemState("/test")[2][0]).get(topic, [])

    def subscribers(self, topic):
        return dict(self.master.getSystemState("/test")[2][1]).get(topic, [])

    def close(self):
        for process in self.processes:
            process.kill()
        if self.core.poll() is None:
            self.core.send_signal(signal.SIGINT)
            self.core.wait(30)


@pytest.fixture(scope="session")
def program():
    return example("ros1", "ros1_probe")


@pytest.fixture(scope="module")
def core(program, tmp_path_factory):
    ros = Ros(tmp_path_factory.mktemp("ros"), program)
    yield ros
    ros.close()


@pytest.fixture
def ros(core):
    """The module's roscore, with the programs of one test."""
    yield core
    while core.processes:
        core.processes.pop().kill()
