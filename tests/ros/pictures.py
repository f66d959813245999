"""Images for the tests: generated here, or the photographs of OPENDR_TEST_DATA."""

import os
from pathlib import Path

import pytest
from peers import ROOT


def noise(width, height):
    """Returns RGB bytes in which no detector detects anything."""
    return bytes((x * 7 + y * 13 + 31 * channel) % 256 for y in range(height) for x in range(width) for channel in range(3))


def photograph(name):
    """The path of one of the shared photographs."""
    named = os.environ.get("OPENDR_TEST_DATA")
    path = (Path(named) if named else ROOT.parent / "shared") / "data/photos" / name
    if not path.is_file():
        pytest.skip("skipped: no OPENDR_TEST_DATA")
    return path


def image_fields(width, height, rgb, sec=1, nanosec=0, frame_id="camera"):
    """sensor_msgs/Image of RGB bytes as plain values."""
    header = {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": frame_id}
    return {
        "header": header, "height": height, "width": width, "encoding": "rgb8", "step": width * 3, "data": list(rgb),
    }
