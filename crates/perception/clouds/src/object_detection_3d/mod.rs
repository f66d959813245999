//! 3D object detection in point clouds.

pub mod voxel_object_detection;

#[cfg(feature = "training")]
pub use voxel_object_detection::{PillarObjective, VoxelObjectDetection3dFitParams};
pub use voxel_object_detection::{Scan, VoxelObjectDetection3d, VoxelObjectDetection3dParams};
