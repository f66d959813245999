//! Panoptic segmentation: classes and objects for all of a picture, or of a lidar scan.
//!
//! Begin with [`panoptic_segmentation::EfficientPs`] for pictures, [`panoptic_segmentation::EfficientLps`] for scans.

pub mod panoptic_segmentation;
