//! `nav_msgs`.

// Made by `cargo xtask generate` from the definitions in `msg/` and `ros1/`: not edited by hand.

use serde::{Deserialize, Serialize};

/// `nav_msgs/Odometry`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Odometry {
    pub header: crate::std_msgs::Header,
    pub child_frame_id: String,
    pub pose: crate::geometry_msgs::PoseWithCovariance,
    pub twist: crate::geometry_msgs::TwistWithCovariance,
}

/// `nav_msgs/Path`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Path {
    pub header: crate::std_msgs::Header,
    pub poses: Vec<crate::geometry_msgs::PoseStamped>,
}
