//! Inference on large images in tiles, and the learners that support it.

#[cfg(feature = "detection")]
pub use opendr_detection::object_detection_2d::DETECTORS;
#[cfg(feature = "segmentation")]
pub use opendr_segmentation::semantic_segmentation::SEGMENTERS;
pub use opendr_tiling::*;
