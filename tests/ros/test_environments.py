"""Environments as nodes: a policy of OpenDR balances a pole over ROS, and rclpy subscribes to it."""

import subprocess
from contextlib import ExitStack

from node import Node, environment, opendr
from patience import wait_until


class World(Node):
    """`opendr ros2 env`."""

    verb = "env"


def test_a_policy_keeps_the_pole_up(ros2):
    with ExitStack() as stack:
        stack.enter_context(World("ros2", "CartPole-v1", "--action", "/ppo/target", "--seed", "3", ROS_DOMAIN_ID=ros2.domain))
        stack.enter_context(Node("ros2", "ppo", "--observation", "/CartPole_v1/observation", ROS_DOMAIN_ID=ros2.domain))
        rewards = ros2.subscribe("/CartPole_v1/reward", "std_msgs/msg/Float32")
        overs = ros2.subscribe("/CartPole_v1/is_over", "std_msgs/msg/Bool")
        seen = ros2.subscribe("/CartPole_v1/observation", "opendr_msgs/msg/Observation", qos="best_effort")
        wait_until(lambda: len(rewards.messages) >= 400, 120, "400 steps")
        ended = [ros2.decode("std_msgs/msg/Bool", message.data)["data"] for message in list(overs.messages)]
    assert sum(ended) <= 1, "a random policy falls every 20 steps"
    [part] = ros2.decode("opendr_msgs/msg/Observation", seen.messages[0].data)["parts"]
    assert len(part["array"]["data"]) == 4


def test_usage_errors_are_told():
    def run(*words):
        command = [opendr(), "ros2", "env", *words]
        return subprocess.run(command, env=environment(), capture_output=True, text=True, timeout=60)

    assert run("Nonsense-v1").returncode == 13
    assert run("CartPole-v1", "--action-message", "std_msgs/msg/String").returncode == 11
    assert run("CartPole-v1", "--rate", "0").returncode == 12
