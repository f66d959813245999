"""`opendr.ros_bridge` on rclpy's own messages."""

import json
import os
import subprocess

import peers
import pytest


@pytest.mark.parametrize("distribution", peers.DISTRIBUTIONS)
def test_messages_of_rclpy(distribution):
    package = os.environ.get("OPENDR_PYTHON_PACKAGE")
    if package is None:
        pytest.skip("OPENDR_PYTHON_PACKAGE names no folder with the built package")
    program = [peers.interpreter(distribution), peers.HERE / "bridge_program.py"]
    unwanted = ("_ROS_WHEELS_BOOTSTRAP_COMPLETE", "LD_LIBRARY_PATH")
    environment = {name: value for name, value in os.environ.items() if name not in unwanted}
    done = subprocess.run(program, env={**environment, "PYTHONPATH": package}, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    seen = json.loads(done.stdout)
    errors = seen.pop("errors")
    assert errors == ["FormatError", "FormatError", "Unsupported", "TypeError"]
    assert seen == {
        "shape": [3, 2, 3],
        "frame_id": "eye",
        "stamp": 7_000_000_000,
        "first": [2, 1, 0],
        "same": True,
        "depth": [65535, 1],
        "class_id": "3",
        "centre": 6.5,
        "back": [1.5, 2.0, 10.0, 4.0, 0.25, 3],
        "tracks": 1,
        "jpeg": "ffd8",
        "usual": "Image",
        "detections": True,
        "image": True,
    }
