"""A node of the command in a file system with only the command and the C library."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from node import Node, opendr
from patience import wait_until
from pictures import image_fields, noise

LEARNER = "image_classifier"
WEIGHTS = Path(__file__).parents[2] / "models/weights"
CHROOT = "/usr/sbin/chroot"
SYSTEM = {"libc", "libm", "libgcc_s", "ld-linux-x86-64", "ld-linux-aarch64", "libdl", "libpthread", "librt"}


def needed(program):
    """Shared libraries of a program with their paths, the loader among them."""
    lines = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout.splitlines()
    words = [line.split() for line in lines if "/" in line]
    return [next(word for word in row if word.startswith("/")) for row in words]


class Bare(Node):
    """A node in a root of its own."""

    def __init__(self, root, **more):
        self.root = root
        super().__init__("ros2", LEARNER, **more)

    def command(self, ros, *words):
        return [CHROOT, str(self.root), "/opendr", ros, "run", *words]


def test_it_needs_libc_alone(ros2, tmp_path):
    if os.geteuid() != 0 or not os.path.exists(CHROOT):
        pytest.skip("a root of its own takes a superuser")
    libraries = needed(opendr())
    assert {os.path.basename(library).split(".so")[0] for library in libraries} <= SYSTEM
    for library in libraries:
        target = tmp_path / library.lstrip("/")
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(os.path.realpath(library), target)
    shutil.copy(opendr(), tmp_path / "opendr")
    shutil.copytree(WEIGHTS / LEARNER, tmp_path / "models" / LEARNER)
    alone = {"OPENDR_MODELS": "/models", "ROS_DOMAIN_ID": ros2.domain, "OPENDR_CACHE": "/cache", "HOME": "/", "ORT_DYLIB_PATH": ""}
    with Bare(tmp_path, **alone):
        seen = ros2.subscribe(f"/{LEARNER}/category", "vision_msgs/msg/Classification")
        seen.wait_for_publishers()
        picture = ros2.encode("sensor_msgs/msg/Image", image_fields(64, 48, noise(64, 48), sec=5))
        sending = ros2.publish("/image_raw", "sensor_msgs/msg/Image", [picture], count=50, rate=10, background=True)
        wait_until(lambda: seen.messages, 60, "an answer")
        sending.result(60)
