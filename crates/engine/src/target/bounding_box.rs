//! Bounding boxes in an image, for 2D detection.

use std::fmt;

use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use crate::Header;
use crate::numpy_text::{Number, array_str};
use crate::target::json_number::null_as_nan;
use crate::target::{Action, Classes, Name, Segment, mean};

/// A bounding box in an image: top left corner and size in pixels.
///
/// With a [`Segment`] it is OpenDR's `CocoBoundingBox`. `{}` writes OpenDR's text (`mot()`, or `coco()` with a segment),
/// `{:#}` a readable line.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BoundingBox {
    /// Class index or label.
    pub name: Name,
    /// Left edge in pixels.
    #[serde(deserialize_with = "null_as_nan")]
    pub left: f32,
    /// Upper edge in pixels.
    #[serde(deserialize_with = "null_as_nan")]
    pub top: f32,
    /// Width in pixels.
    #[serde(deserialize_with = "null_as_nan")]
    pub width: f32,
    /// Height in pixels.
    #[serde(deserialize_with = "null_as_nan")]
    pub height: f32,
    /// Score, 0..=1.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub confidence: f32,
    /// Landmarks of the object (eyes, nose and mouth corners of a face), `[x, y]` in pixels. Up to five are stored inline, so
    /// that filling a list of faces allocates nothing.
    #[serde(default, skip_serializing_if = "SmallVec::is_empty", deserialize_with = "null_as_nan")]
    pub landmarks: SmallVec<[[f32; 2]; 5]>,
    /// Mask of the object, if known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub segment: Option<Box<Segment>>,
}

impl BoundingBox {
    /// Creates a box from its top left corner and size.
    pub fn new(name: impl Into<Name>, left: f32, top: f32, width: f32, height: f32, confidence: f32) -> Self {
        Self { name: name.into(), left, top, width, height, confidence, ..Self::default() }
    }

    /// Creates a box from two corners `[x0, y0, x1, y1]`.
    pub fn from_corners(name: impl Into<Name>, [x0, y0, x1, y1]: [f32; 4], confidence: f32) -> Self {
        Self::new(name, x0, y0, x1 - x0, y1 - y0, confidence)
    }

    /// Returns the corners `[x0, y0, x1, y1]`.
    pub fn corners(&self) -> [f32; 4] {
        [self.left, self.top, self.left + self.width, self.top + self.height]
    }

    /// Returns the area in square pixels; 0 if a side is negative or NaN.
    pub fn area(&self) -> f32 {
        self.width.max(0.0) * self.height.max(0.0)
    }

    /// Writes score and position, after the label of a readable line.
    pub(super) fn write_place(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { left, top, width, height, confidence, .. } = self;
        write!(f, " {confidence:.2} at left {left:.1} top {top:.1} width {width:.1} height {height:.1}")
    }
}

impl fmt::Display for BoundingBox {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            Classes::default().write_label(&self.name, f)?;
            return self.write_place(f);
        }
        match &self.segment {
            Some(_) => self.coco(true).fmt(f),
            None => {
                let row = self.mot(None);
                f.write_str(&array_str(&[row.len()], &|at| Number::F32(row[at])))
            }
        }
    }
}

/// The bounding boxes in an image, best first.
///
/// `{}` writes OpenDR's text (rows of `mot()`), `{:#}` a readable line per box.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BoundingBoxList {
    /// Header of the image.
    #[serde(flatten)]
    pub header: Header,
    /// The boxes.
    pub boxes: Vec<BoundingBox>,
    /// Class names.
    #[serde(default, skip_serializing_if = "Classes::is_empty")]
    pub classes: Classes,
    /// Id of the image in its data set, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image_id: Option<i64>,
    /// Proposed camera motion for a better view.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

impl BoundingBoxList {
    /// Returns the label of a box of this list: its own, or the name of its class index.
    pub fn label<'a>(&'a self, bounding_box: &'a BoundingBox) -> Option<&'a str> {
        self.classes.label(&bounding_box.name)
    }
}

target!(BoundingBoxList, |list| Some(mean(list.boxes.iter().map(|found| found.confidence))));

impl From<Vec<BoundingBox>> for BoundingBoxList {
    fn from(boxes: Vec<BoundingBox>) -> Self {
        Self { boxes, ..Self::default() }
    }
}

impl fmt::Display for BoundingBoxList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !f.alternate() {
            return crate::target::write_rows(&self.mot(None), f);
        }
        for found in &self.boxes {
            self.classes.write_label(&found.name, f)?;
            found.write_place(f)?;
            writeln!(f)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::{Rle, Segmentation, Target};

    /// The texts are those of OpenDR 3.0.0.
    #[test]
    fn texts_are_those_of_opendr() {
        let first = BoundingBox::new(0, 10.5, 20.0, 30.0, 40.25, 0.9);
        assert_eq!(first.to_string(), "[-1.   10.5  20.   30.   40.25  0.9 ]");
        let second = BoundingBox::new("person", -1.0, 2.0, 300.0, 4.0, 0.5);
        let list = BoundingBoxList::from(vec![first, second]);
        assert_eq!(
            list.to_string(),
            "[[ -1.    10.5   20.    30.    40.25   0.9 ]\n [ -1.    -1.     2.   300.     4.     0.5 ]]"
        );
        assert_eq!(
            format!("{list:#}"),
            "class 0 0.90 at left 10.5 top 20.0 width 30.0 height 40.2\n\
             person 0.50 at left -1.0 top 2.0 width 300.0 height 4.0\n"
        );
        assert_eq!(list.confidence(), Some(0.7));
        assert_eq!(BoundingBoxList::default().to_string(), "[]");
        assert_eq!(BoundingBoxList::default().confidence(), Some(0.0));
    }

    #[test]
    fn boxes_with_masks_are_printed_as_coco() {
        let segmentation = Segmentation::Rle(Rle::new(2, 2, vec![1, 3]).unwrap());
        let segment = Some(Box::new(Segment { segmentation, area: 3.0, iscrowd: true }));
        let found = BoundingBox { segment, ..BoundingBox::new(1, 0.0, 0.0, 2.0, 2.0, 0.5) };
        assert_eq!(
            found.to_string(),
            "{'bbox': [0.0, 0.0, 2.0, 2.0], 'category_id': 1, 'area': 3.0, \
             'segmentation': {'size': [2, 2], 'counts': '13'}, 'iscrowd': 1, 'confidence': 0.5}"
        );
    }
}
