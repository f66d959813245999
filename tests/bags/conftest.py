"""Recordings of crates/bags beside the tools that people have: rosbags, mcap and ROS 1's own."""

import hashlib
import json
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def example(name):
    program = os.environ.get(f"OPENDR_{name.upper()}")
    return [program] if program else ["cargo", "run", "-q", "-p", "opendr-bags", "--example", name, "--"]


def told(topic, time, data):
    """A message as the tests compare it."""
    return topic, time, hashlib.sha256(bytes(data)).hexdigest()


@pytest.fixture(scope="session")
def dump():
    """What crates/bags reads: the recording's description, and its messages as `told` tells them."""

    def run(path, *options):
        command = [*example("bag_dump"), str(path), *map(str, options)]
        done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
        head, *messages = map(json.loads, done.stdout.splitlines())
        return head, [(one["topic"], one["log_time_ns"], one["sha256"]) for one in messages]

    return run


@pytest.fixture(scope="session")
def copy():
    """Has crates/bags copy a recording into another format; returns the copy."""

    def run(source, target, form, *options):
        command = [*example("bag_copy"), str(source), str(target), "--format", form, *options]
        subprocess.run(command, cwd=ROOT, check=True)
        return target

    return run
