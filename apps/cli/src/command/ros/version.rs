//! The two versions of ROS, and the constants of their commands.

/// Marker before the arguments in the syntax of ROS's own tools.
pub const ROS_ARGS: &str = "--ros-args";

/// Version of ROS.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ros {
    One,
    Two,
}

impl Ros {
    pub const fn name(self) -> &'static str {
        match self {
            Self::One => "ros1",
            Self::Two => "ros2",
        }
    }

    pub const fn examples(self) -> &'static str {
        match self {
            Self::One => {
                "\
Examples:
  opendr ros1 run nanodet --image /camera/image_raw
  opendr ros1 run nanodet --threshold 0.5 + yunet       two nodes; each image is decoded once
  opendr ros1 run nanodet --ros-args -r __ns:=/robot -r image_raw:=/camera/image_raw
  opendr ros1 run LEARNER --help                        list the topics and parameters"
            }
            Self::Two => {
                "\
Examples:
  opendr ros2 run nanodet --image /camera/image_raw
  opendr ros2 run nanodet --image /cam/compressed --image-message sensor_msgs/msg/CompressedImage
  opendr ros2 run nanodet --threshold 0.5 + yunet       two nodes; each image is decoded once
  opendr ros2 run nanodet --ros-args -r __ns:=/robot -r image_raw:=/camera/image_raw -p threshold:=0.5
  opendr ros2 run LEARNER --help                        list the topics and parameters"
            }
        }
    }
}
