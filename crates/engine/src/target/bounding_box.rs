//! Boxes in a picture: 2D detection.

use std::fmt;

use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use crate::Header;
use crate::target::{Action, Classes, Name};

/// A box in a picture: left-top corner and size in pixels.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BoundingBox {
    /// Class number or label.
    pub name: Name,
    /// Left edge, pixels.
    pub left: f32,
    /// Upper edge, pixels.
    pub top: f32,
    /// Pixels to the right edge.
    pub width: f32,
    /// Pixels to the lower edge.
    pub height: f32,
    /// Score, 0..=1.
    #[serde(default)]
    pub confidence: f32,
    /// Points that belong to the box (eyes, nose, corners of the mouth of a face), `[x, y]` in pixels.
    /// Up to five lie in place, so that filling a list of faces allocates nothing.
    #[serde(default, skip_serializing_if = "SmallVec::is_empty")]
    pub landmarks: SmallVec<[[f32; 2]; 5]>,
}

impl BoundingBox {
    /// A box from its left-top corner and size.
    pub fn new(name: impl Into<Name>, left: f32, top: f32, width: f32, height: f32, confidence: f32) -> Self {
        Self { name: name.into(), left, top, width, height, confidence, landmarks: SmallVec::new() }
    }

    /// A box from two corners `[x0, y0, x1, y1]`.
    pub fn from_corners(name: impl Into<Name>, [x0, y0, x1, y1]: [f32; 4], confidence: f32) -> Self {
        Self::new(name, x0, y0, x1 - x0, y1 - y0, confidence)
    }

    /// `[x0, y0, x1, y1]`.
    pub fn corners(&self) -> [f32; 4] {
        [self.left, self.top, self.left + self.width, self.top + self.height]
    }

    /// Square pixels; 0 when a side is negative or NaN.
    pub fn area(&self) -> f32 {
        self.width.max(0.0) * self.height.max(0.0)
    }
}

/// The boxes found in one picture, best first.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BoundingBoxList {
    /// Of the picture.
    #[serde(flatten)]
    pub header: Header,
    /// The boxes.
    pub boxes: Vec<BoundingBox>,
    /// What class numbers mean.
    #[serde(default, skip_serializing_if = "Classes::is_empty")]
    pub classes: Classes,
    /// The picture's number in its data set, where it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image_id: Option<i64>,
    /// How to move to see better.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

impl BoundingBoxList {
    /// Mean score of the boxes, 0 when there is none.
    pub fn confidence(&self) -> f32 {
        if self.boxes.is_empty() {
            return 0.0;
        }
        self.boxes.iter().map(|found| found.confidence).sum::<f32>() / self.boxes.len() as f32
    }

    /// The label of a box of this list: its own, or the class name under its number.
    pub fn label<'a>(&'a self, found: &'a BoundingBox) -> Option<&'a str> {
        match &found.name {
            Name::Label(label) => Some(label),
            Name::Index(index) => self.classes.name(*index).map(AsRef::as_ref),
        }
    }
}

impl From<Vec<BoundingBox>> for BoundingBoxList {
    fn from(boxes: Vec<BoundingBox>) -> Self {
        Self { boxes, ..Self::default() }
    }
}

impl fmt::Display for BoundingBoxList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for found in &self.boxes {
            match self.label(found) {
                Some(label) => write!(f, "{label}")?,
                None => write!(f, "class {}", found.name)?,
            }
            writeln!(
                f,
                " {:.2} at left {:.1} top {:.1} width {:.1} height {:.1}",
                found.confidence, found.left, found.top, found.width, found.height
            )?;
        }
        Ok(())
    }
}
