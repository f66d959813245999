"""Recordings of crates/bags, compared with rosbags, mcap and ROS 1's own tools."""

import hashlib
import json
import os
import subprocess
from pathlib import Path

import pytest
from programs import example

ROOT = Path(__file__).resolve().parents[2]


def told(topic, time, data):
    """A message as the tests compare it."""
    return topic, time, hashlib.sha256(bytes(data)).hexdigest()


@pytest.fixture(scope="session")
def dump():
    """Returns the recording's description and its messages as crates/bags reads them."""

    def run(path, *options):
        command = [*example("bags", "bag_dump"), str(path), *map(str, options)]
        done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
        head, *messages = map(json.loads, done.stdout.splitlines())
        return head, [(one["topic"], one["log_time_ns"], one["sha256"]) for one in messages]

    return run


@pytest.fixture(scope="session")
def copy():
    """Has crates/bags copy a recording into another format; returns the copy."""

    def run(source, target, form, *options):
        command = [*example("bags", "bag_copy"), str(source), str(target), "--format", form, *options]
        subprocess.run(command, cwd=ROOT, check=True)
        return target

    return run


class Command:
    """Runs the opendr command, checks its exit code, and returns its output."""

    def __init__(self):
        program = os.environ.get("OPENDR_BIN")
        self.program = [program] if program else ["cargo", "run", "-q", "-p", "opendr-cli", "--"]

    def __call__(self, *words, code=0):
        command = [*self.program, *map(str, words)]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
        assert done.returncode == code, f"{command}: {done.returncode}\n{done.stdout}\n{done.stderr}"
        assert "panicked" not in done.stderr
        return Done(done.stdout, done.stderr)


class Done:
    def __init__(self, stdout, stderr):
        self.stdout, self.stderr = stdout, stderr

    @property
    def lines(self):
        return [json.loads(line) for line in self.stdout.splitlines()]


@pytest.fixture(scope="session")
def opendr():
    return Command()
