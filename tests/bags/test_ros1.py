"""Bags of ROS 1's own rosbag are read, and its tools read ours."""

import json
import os
import socket
import subprocess
from pathlib import Path

import pytest
from conftest import told
from messages import START, STEP, talk

# Debian's packages are for the system's interpreter.
PYTHON = "/usr/bin/python3"
SCRIPT = Path(__file__).with_name("ros1.py")
FOUND = subprocess.run([PYTHON, "-c", "import rosbag, sensor_msgs, std_msgs"], capture_output=True, check=False)

pytestmark = pytest.mark.skipif(FOUND.returncode != 0, reason="python3-rosbag and messages of Debian are missing")


def environment():
    return {key: value for key, value in os.environ.items() if key not in {"PYTHONPATH", "VIRTUAL_ENV"}}


def run(*command):
    done = subprocess.run([*map(str, command)], env=environment(), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def wanted():
    return sorted(told(*message) for message in talk(False))


def write(path, compression="none", verb="write"):
    run(PYTHON, SCRIPT, verb, path, compression)
    return path


def read(path):
    messages = [tuple(json.loads(line)) for line in run(PYTHON, SCRIPT, "read", path).splitlines()]
    times = [time for _, time, _ in messages]
    assert times == sorted(times)
    return sorted(messages)


def facts(path):
    """Returns the output of `rosbag info` without the end, which it takes from the message written last, not the latest."""
    lines = [line.split(":", 1) for line in run("rosbag", "info", path).splitlines() if ":" in line]
    return {key: value.strip() for key, value in lines if key in {"version", "start", "messages"}}


@pytest.mark.parametrize("compression", ["none", "bz2", "lz4"])
def test_bags_are_read(tmp_path, dump, compression):
    head, messages = dump(write(tmp_path / "a.bag", compression))
    assert (head["format"], head["is_complete"], head["messages"]) == ("bag1", True, 120)
    assert (head["start_ns"], head["end_ns"]) == (START, START + 59 * STEP)
    assert sorted(messages) == wanted()
    kinds = {channel["topic"]: (channel["type"], channel["hash"]) for channel in head["channels"]}
    assert kinds == {
        "/camera/image_raw": ("sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743"),
        "/chatter": ("std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1"),
    }


def test_a_bag_whose_recorder_was_killed_is_read(tmp_path, dump):
    head, messages = dump(write(tmp_path / "a.bag", verb="leave"))
    assert not head["is_complete"]
    # Messages of the last chunk, which was still open, are read too.
    assert sorted(messages) == wanted()


@pytest.mark.parametrize("options", [[], ["--lz4"]])
def test_our_bags_are_read(tmp_path, copy, options):
    theirs = write(tmp_path / "a.bag")
    ours = copy(theirs, tmp_path / "b.bag", "bag1", *options)
    assert read(ours) == wanted() == read(theirs)
    info = {path: facts(path) for path in (ours, theirs)}
    assert info[ours] == info[theirs]
    assert info[ours]["messages"] == "120"
    run("rosbag", "check", ours)
    run("rosbag", "filter", ours, tmp_path / "filtered.bag", "topic == '/chatter'")
    assert facts(tmp_path / "filtered.bag")["messages"] == "60"
    (tmp_path / "packed").mkdir()
    run("rosbag", "compress", "--bz2", "--output-dir", tmp_path / "packed", "--quiet", ours)
    assert read(tmp_path / "packed" / "b.bag") == wanted()


def test_our_bag_whose_writer_was_killed_is_mended_by_reindex(tmp_path, copy):
    ours = copy(write(tmp_path / "a.bag"), tmp_path / "b.bag", "bag1")
    whole = bytearray(ours.read_bytes())
    # As left by a killed writer: the header does not have the position of the index yet.
    at = whole.index(b"index_pos=") + len(b"index_pos=")
    whole[at : at + 8] = bytes(8)
    ours.write_bytes(whole[: int(len(whole) * 0.9)])
    run("rosbag", "reindex", "--quiet", ours)
    assert int(facts(ours)["messages"]) > 60


@pytest.fixture
def master(monkeypatch):
    """ROS 1's name service on a port of its own."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    monkeypatch.setenv("ROS_MASTER_URI", f"http://127.0.0.1:{port}")
    monkeypatch.setenv("ROS_IP", "127.0.0.1")
    monkeypatch.setenv("ROS_HOSTNAME", "127.0.0.1")
    command = [PYTHON, "-c", f"import rosmaster.master as m, time; m.Master({port}).start(); time.sleep(600)"]
    with subprocess.Popen(command, env=environment()) as process:
        yield
        process.kill()


def test_our_bag_is_played(tmp_path, copy, master):
    ours = copy(write(tmp_path / "a.bag"), tmp_path / "b.bag", "bag1", "--lz4")
    listen = [PYTHON, str(SCRIPT), "listen", "120"]
    with subprocess.Popen(listen, env=environment(), stdout=subprocess.PIPE, text=True) as listener:
        assert listener.stdout.readline() == "ready\n"
        run("/usr/lib/rosbag/play", "--quiet", "--delay=2", ours)
        heard = json.loads(listener.stdout.readline())
    assert sorted(map(tuple, heard)) == sorted((topic, digest) for topic, _, digest in wanted())
