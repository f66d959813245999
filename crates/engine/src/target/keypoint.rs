//! Keypoints.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::numpy_text::python_float;
use crate::target::json_number::null_as_nan;

/// A keypoint in an image, in pixels; `(-1, -1)` means not detected. `{}` writes `[x, y]`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[repr(C)] // The C API points to keypoints in place.
pub struct Keypoint {
    /// Distance from the left edge, in pixels.
    #[serde(deserialize_with = "null_as_nan")]
    pub x: f32,
    /// Distance from the upper edge, in pixels.
    #[serde(deserialize_with = "null_as_nan")]
    pub y: f32,
    /// Score, 0..=1.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub confidence: f32,
}

impl Keypoint {
    /// A keypoint that was not detected.
    pub const MISSING: Self = Self { x: -1.0, y: -1.0, confidence: 0.0 };

    /// Returns whether the keypoint was detected.
    pub fn is_detected(&self) -> bool {
        self.x >= 0.0 && self.y >= 0.0
    }
}

impl Default for Keypoint {
    fn default() -> Self {
        Self::MISSING
    }
}

impl fmt::Display for Keypoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[{}, {}]", python_float(self.x), python_float(self.y))
    }
}
