"""Fixtures of the tests with real ROS peers: OpenDR's messages by the examples of crates/messages, and the peers."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent))

import peers  # noqa: E402
from message_echo import MessageEcho  # noqa: E402
from programs import example  # noqa: E402


@pytest.fixture(scope="session")
def message_types_file(tmp_path_factory):
    """The output of the example message_types."""
    file = tmp_path_factory.mktemp("messages") / "message_types.jsonl"
    with file.open("wb") as out:
        subprocess.run(example("messages", "message_types"), stdout=out, check=True)
    return file


@pytest.fixture(scope="session")
def known(message_types_file):
    """OpenDR's messages and services as dicts."""
    return [json.loads(line) for line in message_types_file.read_text().splitlines()]


@pytest.fixture
def echo():
    """OpenDR reads messages and writes them again."""
    with MessageEcho(example("messages", "message_echo")) as echo:
        yield echo


@pytest.fixture(scope="module", params=peers.DISTRIBUTIONS)
def ros2(request):
    """An rclpy node, one of each distribution, alone in its domain."""
    with peers.Ros2Peer(request.param, peers.new_domain()) as peer:
        yield peer


@pytest.fixture(scope="module")
def ros1():
    """rospy's messages, without a master."""
    with peers.Ros1Peer() as peer:
        yield peer


@pytest.fixture(scope="module")
def roscore(tmp_path_factory):
    with peers.Roscore(tmp_path_factory.mktemp("roscore")) as roscore:
        yield roscore
