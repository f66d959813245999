"""`opendr ros2 run` and `opendr ros1 run` in a process of their own."""

import os
import queue
import signal
import subprocess
import threading

from patience import PATIENCE
from peers import ROOT, TARGET

# The first image takes longer: models are read, memory is allocated.
START = 120


def opendr():
    """The built command."""
    return os.environ.get("OPENDR_BIN", str(TARGET / "debug/opendr"))


def environment():
    """Environment that limits the command to included models and those in the tests' cache."""
    cache = os.environ.get("OPENDR_TEST_CACHE", str(TARGET / "test-cache"))
    return {**os.environ, "OPENDR_CACHE": os.path.join(cache, "opendr")}


class Node:
    """A node, from its message that it is ready until the end of the block."""

    verb = "run"

    def __init__(self, ros, *words, ready=1, **more):
        self.process = subprocess.Popen(
            self.command(ros, *words),
            env={**environment(), **{name: str(value) for name, value in more.items()}},
            stdin=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            cwd=ROOT,
        )
        self.lines = []
        self.new_lines = queue.Queue()
        threading.Thread(target=self._listen, daemon=True).start()
        for _ in range(ready):
            self.wait_for_line("is ready as", START)

    def command(self, ros, *words):
        return [opendr(), ros, self.verb, *map(str, words)]

    def _listen(self):
        for line in self.process.stderr:
            self.lines.append(line.rstrip("\n"))
            self.new_lines.put(self.lines[-1])
        self.new_lines.put(None)

    def wait_for_line(self, part, timeout=PATIENCE):
        """Returns the next line with `part` that the node prints."""
        while True:
            line = self.new_lines.get(timeout=timeout)
            assert line is not None, f"the node has ended: {self.lines}"
            if part in line:
                return line

    def memory(self):
        """Returns the memory of the process in bytes."""
        with open(f"/proc/{self.process.pid}/status") as status:
            return 1024 * next(int(line.split()[1]) for line in status if line.startswith("VmRSS"))

    def stop(self, how=signal.SIGINT):
        """Ends the process and returns its exit code."""
        self.process.send_signal(how)
        return self.process.wait(PATIENCE)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.process.stderr.close()
