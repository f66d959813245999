"""The tutorials of ROS are followed word for word, with rclpy of each distribution and with rospy."""

import os

import peers
import pytest
from node import environment, opendr
from tutorial import Reader


def follow(page, folder, python, **more):
    # What the wheels' start-up leaves in the environment is for one distribution.
    unwanted = ("_ROS_WHEELS_BOOTSTRAP_COMPLETE", "LD_LIBRARY_PATH", "PYTHONPATH")
    inherited = {name: value for name, value in environment().items() if name not in unwanted}
    (folder / "reader").mkdir()
    programs = {"opendr": os.path.abspath(opendr()), "python3": python}
    with Reader(page, folder / "reader", {**inherited, **more}, programs) as reader:
        reader.follow()


@pytest.mark.parametrize("distribution", peers.DISTRIBUTIONS)
def test_ros2(distribution, tmp_path):
    follow("ros2.md", tmp_path, peers.interpreter(distribution), ROS_DOMAIN_ID=str(peers.new_domain()))


def test_ros1(roscore, tmp_path):
    follow("ros1.md", tmp_path, peers.DEBIAN_PYTHON, **roscore.environment)
