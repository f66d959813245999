//! The outline of an object: what makes a box OpenDR's `CocoBoundingBox`.

use serde::{Deserialize, Serialize};

use crate::target::Rle;
use crate::target::json_number::null_as_nan;

/// Which pixels belong to an object, as COCO writes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Segmentation {
    /// Outlines `[x0, y0, x1, y1, ...]` in pixels; an object that is partly hidden has several.
    #[serde(deserialize_with = "null_as_nan")]
    Polygons(Vec<Vec<f32>>),
    /// A mask by runs.
    Rle(Rle),
}

impl Segmentation {
    /// Whether no pixel is named.
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Polygons(polygons) => polygons.is_empty(),
            Self::Rle(rle) => rle.counts().is_empty(),
        }
    }
}

impl Default for Segmentation {
    fn default() -> Self {
        Self::Polygons(Vec::new())
    }
}

/// The outline of an object, its size, and whether it is a crowd.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Segment {
    /// The pixels.
    pub segmentation: Segmentation,
    /// Square pixels of the object (not of its box).
    #[serde(default, deserialize_with = "null_as_nan")]
    pub area: f32,
    /// Whether it is a crowd: detections inside count neither as right nor as wrong.
    #[serde(default)]
    pub iscrowd: bool,
}
