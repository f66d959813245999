//! Large pictures in tiles, with the learners that can look at them.

#[cfg(feature = "detection")]
pub use opendr_detection::object_detection_2d::DETECTORS;
#[cfg(feature = "segmentation")]
pub use opendr_segmentation::semantic_segmentation::SEGMENTERS;
pub use opendr_tiling::*;
