//! `vision_msgs`.

// Made by `cargo xtask generate` from the definitions in `msg/` and `ros1/`: not edited by hand.

use serde::{Deserialize, Serialize};

/// `vision_msgs/BoundingBox2D`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct BoundingBox2D {
    pub center: Pose2D,
    pub size_x: f64,
    pub size_y: f64,
}

/// `vision_msgs/BoundingBox2DArray`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct BoundingBox2DArray {
    pub header: crate::std_msgs::Header,
    pub boxes: Vec<BoundingBox2D>,
}

/// `vision_msgs/BoundingBox3D`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct BoundingBox3D {
    pub center: crate::geometry_msgs::Pose,
    pub size: crate::geometry_msgs::Vector3,
}

/// `vision_msgs/BoundingBox3DArray`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct BoundingBox3DArray {
    pub header: crate::std_msgs::Header,
    pub boxes: Vec<BoundingBox3D>,
}

/// `vision_msgs/Classification`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Classification {
    pub header: crate::std_msgs::Header,
    pub results: Vec<ObjectHypothesis>,
}

/// `vision_msgs/Detection2D`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Detection2D {
    pub header: crate::std_msgs::Header,
    pub results: Vec<ObjectHypothesisWithPose>,
    pub bbox: BoundingBox2D,
    pub id: String,
}

/// `vision_msgs/Detection2DArray`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Detection2DArray {
    pub header: crate::std_msgs::Header,
    pub detections: Vec<Detection2D>,
}

/// `vision_msgs/Detection3D`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Detection3D {
    pub header: crate::std_msgs::Header,
    pub results: Vec<ObjectHypothesisWithPose>,
    pub bbox: BoundingBox3D,
    pub id: String,
}

/// `vision_msgs/Detection3DArray`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Detection3DArray {
    pub header: crate::std_msgs::Header,
    pub detections: Vec<Detection3D>,
}

/// `vision_msgs/LabelInfo`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LabelInfo {
    pub header: crate::std_msgs::Header,
    pub class_map: Vec<VisionClass>,
    pub threshold: f32,
}

/// `vision_msgs/ObjectHypothesis`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ObjectHypothesis {
    pub class_id: String,
    pub score: f64,
}

/// `vision_msgs/ObjectHypothesisWithPose`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ObjectHypothesisWithPose {
    pub hypothesis: ObjectHypothesis,
    pub pose: crate::geometry_msgs::PoseWithCovariance,
}

/// `vision_msgs/Point2D`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Point2D {
    pub x: f64,
    pub y: f64,
}

/// `vision_msgs/Pose2D`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Pose2D {
    pub position: Point2D,
    pub theta: f64,
}

/// `vision_msgs/VisionClass`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct VisionClass {
    pub class_id: u16,
    pub class_name: String,
}

/// `vision_msgs/VisionInfo`.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct VisionInfo {
    pub header: crate::std_msgs::Header,
    pub method: String,
    pub database_location: String,
    pub database_version: i32,
}
