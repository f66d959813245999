"""Broken messages of every type: OpenDR reads them or returns an error, and allocates no memory for missing data."""

import random

import pytest

# The process needs 3 and 5 MiB without a message; an array of unchecked length may allocate 1 MiB at once.
MOST_HAD, MOST_ASKED_FOR = 8 << 20, 16 << 20
LENGTHS = [0xFFFFFFFF, 0x7FFFFFFF, 0x80000000, 0x10000000, 0x00FFFFFF]


def broken(data, values):
    """Cut at every length, bytes changed, lengths changed, more at the end."""
    # For long messages, only the front is changed.
    for length in range(min(len(data), 600)):
        yield data[:length]
    for _ in range(150):
        flipped = bytearray(data)
        for _ in range(values.randint(1, 4)):
            if flipped:
                flipped[values.randrange(min(len(flipped), 600))] = values.randrange(256)
        yield bytes(flipped)
    for at in range(0, min(len(data) - 3, 600)):
        length = LENGTHS[at % len(LENGTHS)].to_bytes(4, "little")
        yield data[:at] + length + data[at + 4 :]
    yield data + b"\xff" * 7


def check(echo, name, wire, samples):
    values = random.Random(name)
    requests = [(name, wire, hostile) for data in samples for hostile in broken(data, values)]
    read = [answer for answer in echo.lines(requests) if not answer.startswith("error: ")]
    # The process is still running and correct.
    assert len(list(echo.lines([(name, wire, samples[0])]))) == 1
    had, asked_for = echo.peak_memory()
    assert had < MOST_HAD and asked_for < MOST_ASKED_FOR, f"{had >> 10} and {asked_for >> 10} KiB after {name}"
    return len(read), len(requests)


def moderate(peer, name):
    """Two messages that are not too long to be broken in many ways."""
    samples = (peer.random(name, seed) for seed in range(100, 130))
    return sorted(samples, key=len)[10:12]


@pytest.mark.parametrize("ros2", ["jazzy"], indirect=True)
def test_cdr(known, ros2, echo):
    read = sent = 0
    for entry in known:
        if "message" in entry:
            few, many = check(echo, entry["message"], "cdr", moderate(ros2, entry["message"]))
            read, sent = read + few, sent + many
    # Some of the changes leave messages, most do not.
    assert 0.05 < read / sent < 0.95


def test_ros1(known, ros1, echo):
    read = sent = 0
    for entry in known:
        if entry.get("ros1"):
            few, many = check(echo, entry["message"], "ros1", moderate(ros1, entry["ros1"]))
            read, sent = read + few, sent + many
    assert 0.05 < read / sent < 0.95


def test_other_representations(echo):
    """Only plain CDR is read, and a line that is no request is answered."""
    for header in ["0002", "0003", "0006", "0007", "0010", "ffff"]:
        [answer] = echo.lines([("std_msgs/msg/Int32", "cdr", bytes.fromhex(header + "000007000000"))])
        assert answer.startswith("error: "), header
    for name, wire in [("std_msgs/msg/Nothing", "cdr"), ("std_msgs/msg/Int32", "json"), ("", "cdr")]:
        [answer] = echo.lines([(name, wire, b"\0" * 8)])
        assert answer.startswith("error: "), name
