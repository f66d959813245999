//! Pillars: what a lidar sees, sorted into a grid on the ground, and the picture that a network takes of it.
//!
//! A. H. Lang et al., "PointPillars: Fast encoders for object detection from point clouds", CVPR 2019. One pass over the
//! points, in their order; what a frame needs of memory is kept for the next.

mod canvas;
mod grid;
mod voxeliser;

pub use canvas::scatter;
pub use grid::PillarGrid;
pub use voxeliser::{PillarPoint, Voxeliser};
