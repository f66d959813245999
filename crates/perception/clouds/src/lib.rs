//! Point clouds: boxes in space, pillars, range images.
//!
//! Begin with [`object_detection_3d::VoxelObjectDetection3d`], whose input is a [`object_detection_3d::Scan`].

pub mod object_detection_3d;
pub mod pillars;
pub mod range_image;
