//! Pillars: points sorted into a grid on the ground, and the canvas that a network takes.
//!
//! A. H. Lang et al., "PointPillars: Fast encoders for object detection from point clouds", CVPR 2019. One pass over the
//! points, in their order; buffers are reused for the next frame.

mod canvas;
mod grid;
mod voxeliser;

pub use canvas::scatter;
pub use grid::PillarGrid;
pub use voxeliser::{PillarPoint, Voxeliser};
