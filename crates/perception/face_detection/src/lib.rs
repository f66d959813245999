//! Face detectors: boxes of faces with five points each.
//!
//! Begin with [`face_detection::Yunet`]. [`face_finder`] is the detector that other learners of faces carry as a part.

pub mod face_detection;
pub mod face_finder;
