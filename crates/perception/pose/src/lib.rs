//! Poses of persons: key points in pictures, and falls.
//!
//! Begin with [`pose_estimation::LightweightOpenPose`]; [`fall_detection::FallDetector`] tells falls by the poses of a stream.

pub mod fall_detection;
pub mod pose_estimation;

mod frame_clock;
