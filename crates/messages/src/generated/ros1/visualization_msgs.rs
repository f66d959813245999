//! `visualization_msgs` as ROS 1 has them.

// Made by `cargo xtask generate` from the definitions in `msg/` and `ros1/`: not edited by hand.

use serde::{Deserialize, Serialize};

/// `visualization_msgs/Marker` of ROS 1.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Marker {
    pub header: crate::std_msgs::Header,
    pub ns: String,
    pub id: i32,
    pub r#type: i32,
    pub action: i32,
    pub pose: crate::geometry_msgs::Pose,
    pub scale: crate::geometry_msgs::Vector3,
    pub color: crate::std_msgs::ColorRGBA,
    pub lifetime: crate::builtin_interfaces::Duration,
    pub frame_locked: bool,
    pub points: Vec<crate::geometry_msgs::Point>,
    pub colors: Vec<crate::std_msgs::ColorRGBA>,
    pub text: String,
    pub mesh_resource: String,
    pub mesh_use_embedded_materials: bool,
}

#[allow(missing_docs)]
impl Marker {
    pub const ARROW: u8 = 0;
    pub const CUBE: u8 = 1;
    pub const SPHERE: u8 = 2;
    pub const CYLINDER: u8 = 3;
    pub const LINE_STRIP: u8 = 4;
    pub const LINE_LIST: u8 = 5;
    pub const CUBE_LIST: u8 = 6;
    pub const SPHERE_LIST: u8 = 7;
    pub const POINTS: u8 = 8;
    pub const TEXT_VIEW_FACING: u8 = 9;
    pub const MESH_RESOURCE: u8 = 10;
    pub const TRIANGLE_LIST: u8 = 11;
    pub const ADD: u8 = 0;
    pub const MODIFY: u8 = 0;
    pub const DELETE: u8 = 2;
    pub const DELETEALL: u8 = 3;
}

/// `visualization_msgs/MarkerArray` of ROS 1.
#[allow(missing_docs)]
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MarkerArray {
    pub markers: Vec<Marker>,
}
