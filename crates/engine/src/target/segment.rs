//! Masks of objects, which make a box OpenDR's `CocoBoundingBox`.

use serde::{Deserialize, Serialize};

use crate::target::Rle;
use crate::target::json_number::null_as_nan;

/// The pixels of an object, as in COCO.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Segmentation {
    /// Polygons `[x0, y0, x1, y1, ...]` in pixels; a partly occluded object may have several.
    #[serde(deserialize_with = "null_as_nan")]
    Polygons(Vec<Vec<f32>>),
    /// Run-length encoded mask.
    Rle(Rle),
}

impl Segmentation {
    /// Returns whether there are no polygons or runs.
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

/// The mask of an object, its area, and whether it is a crowd.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Segment {
    /// Pixels of the object.
    pub segmentation: Segmentation,
    /// Area of the object (not of its box), in square pixels.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub area: f32,
    /// Whether it is a crowd: detections inside count neither as true nor as false positives.
    #[serde(default)]
    pub iscrowd: bool,
}
