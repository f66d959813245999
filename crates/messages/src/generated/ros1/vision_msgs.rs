//! `vision_msgs` as ROS 1 has them.

// Made by `cargo xtask generate` from the definitions in `msg/` and `ros1/`: not edited by hand.

use serde::{Deserialize, Serialize};

/// `vision_msgs/BoundingBox2D` of ROS 1.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct BoundingBox2D {
    pub center: crate::geometry_msgs::Pose2D,
    pub size_x: f64,
    pub size_y: f64,
}

/// `vision_msgs/BoundingBox2DArray` of ROS 1.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct BoundingBox2DArray {
    pub header: crate::std_msgs::Header,
    pub boxes: Vec<BoundingBox2D>,
}

/// `vision_msgs/Classification2D` of ROS 1.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Classification2D {
    pub header: crate::std_msgs::Header,
    pub results: Vec<ObjectHypothesis>,
    pub source_img: crate::sensor_msgs::Image,
}

/// `vision_msgs/Detection2D` of ROS 1.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Detection2D {
    pub header: crate::std_msgs::Header,
    pub results: Vec<ObjectHypothesisWithPose>,
    pub bbox: BoundingBox2D,
    pub source_img: crate::sensor_msgs::Image,
    pub is_tracking: bool,
    pub tracking_id: String,
}

/// `vision_msgs/Detection2DArray` of ROS 1.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Detection2DArray {
    pub header: crate::std_msgs::Header,
    pub detections: Vec<Detection2D>,
}

/// `vision_msgs/Detection3D` of ROS 1.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Detection3D {
    pub header: crate::std_msgs::Header,
    pub results: Vec<ObjectHypothesisWithPose>,
    pub bbox: crate::vision_msgs::BoundingBox3D,
    pub source_cloud: crate::sensor_msgs::PointCloud2,
    pub is_tracking: bool,
    pub tracking_id: String,
}

/// `vision_msgs/Detection3DArray` of ROS 1.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Detection3DArray {
    pub header: crate::std_msgs::Header,
    pub detections: Vec<Detection3D>,
}

/// `vision_msgs/ObjectHypothesis` of ROS 1.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ObjectHypothesis {
    pub id: i64,
    pub score: f64,
}

/// `vision_msgs/ObjectHypothesisWithPose` of ROS 1.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ObjectHypothesisWithPose {
    pub id: i64,
    pub score: f64,
    pub pose: crate::geometry_msgs::PoseWithCovariance,
}
