"""A learner as a node: ros2 launch opendr node.launch.py learner:=nanodet image:=/camera/image_raw namespace:=/robot"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("learner", description="What to run (see opendr models)"),
            DeclareLaunchArgument("image", default_value="image_raw", description="The topic of its picture"),
            DeclareLaunchArgument("name", default_value=LaunchConfiguration("learner"), description="The node's name"),
            DeclareLaunchArgument("namespace", default_value="", description="Where its relative names lie"),
            Node(
                package="opendr",
                executable="node",
                name=LaunchConfiguration("name"),
                namespace=LaunchConfiguration("namespace"),
                arguments=[LaunchConfiguration("learner")],
                remappings=[("image_raw", LaunchConfiguration("image"))],
                output="screen",
            ),
        ]
    )
