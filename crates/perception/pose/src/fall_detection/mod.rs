//! Detection of fallen persons.

mod fall_detector;
mod posture;

pub use fall_detector::{FallDetector, FallDetectorParams, FallDetectorState, FallDetectorTargets};
pub use posture::Posture;
