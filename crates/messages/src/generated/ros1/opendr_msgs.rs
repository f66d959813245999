//! `opendr_msgs` as ROS 1 has them.

// Made by `cargo xtask generate` from the definitions in `msg/` and `ros1/`: not edited by hand.

use serde::{Deserialize, Serialize};

/// `opendr_msgs/ImageWithDetections` of ROS 1: An image with detected boxes.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ImageWithDetections {
    pub header: crate::std_msgs::Header,
    pub image: crate::sensor_msgs::Image,
    pub detections: crate::ros1::vision_msgs::Detection2DArray,
}
