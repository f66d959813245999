//! A point found in a picture.

use serde::{Deserialize, Serialize};

/// A point in a picture, in pixels; `(-1, -1)` means not found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Keypoint {
    /// Pixels from the left edge.
    pub x: f32,
    /// Pixels from the upper edge.
    pub y: f32,
    /// Score, 0..=1.
    #[serde(default)]
    pub confidence: f32,
}

impl Keypoint {
    /// A point that was not found.
    pub const MISSING: Self = Self { x: -1.0, y: -1.0, confidence: 0.0 };

    /// Whether the point was found.
    pub fn is_found(&self) -> bool {
        self.x >= 0.0 && self.y >= 0.0
    }
}

impl Default for Keypoint {
    fn default() -> Self {
        Self::MISSING
    }
}
