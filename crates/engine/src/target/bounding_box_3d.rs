//! Boxes in space: 3D detection.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::Header;
use crate::target::json_number::null_as_nan;
use crate::target::{Action, Classes, Name, mean};

/// A box in space, in the camera frame of KITTI: x right, y down, z ahead.
///
/// Printed, it is OpenDR's text (`kitti()`); `{:#}` gives a readable line.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BoundingBox3D {
    /// Class number or label.
    pub name: Name,
    /// How much of the object lies outside the picture, 0..=1; -1 when it is not known.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub truncated: f32,
    /// 0 visible, 1 partly hidden, 2 mostly hidden, 3 or -1 not known.
    #[serde(default)]
    pub occluded: i32,
    /// Angle under which the object is seen, radians in [-pi, pi].
    #[serde(default, deserialize_with = "null_as_nan")]
    pub alpha: f32,
    /// The object in the picture, corners `[x0, y0, x1, y1]` in pixels.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub bbox2d: [f32; 4],
    /// Length, height and width in metres: OpenDR's order, not that of KITTI's files.
    #[serde(deserialize_with = "null_as_nan")]
    pub dimensions: [f32; 3],
    /// x, y, z of the middle of its floor, metres.
    #[serde(deserialize_with = "null_as_nan")]
    pub location: [f32; 3],
    /// Turn about the vertical axis, radians in [-pi, pi]; 0 looks along x.
    #[serde(deserialize_with = "null_as_nan")]
    pub rotation_y: f32,
    /// Score.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub confidence: f32,
}

impl BoundingBox3D {
    /// Score and place, after the label on a readable line.
    pub(super) fn write_place(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([x, y, z], [length, height, width]) = (self.location, self.dimensions);
        write!(
            f,
            " {:.2} at x {x:.2} y {y:.2} z {z:.2} length {length:.2} height {height:.2} width {width:.2} \
             rotation_y {:.2}",
            self.confidence, self.rotation_y
        )
    }
}

impl fmt::Display for BoundingBox3D {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            Classes::default().write_label(&self.name, f)?;
            return self.write_place(f);
        }
        self.kitti().fmt(f)
    }
}

/// The boxes found in one cloud or picture.
///
/// Printed, it is OpenDR's text (`kitti()`); `{:#}` gives a readable line per box.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BoundingBox3DList {
    /// Of the cloud or picture.
    #[serde(flatten)]
    pub header: Header,
    /// The boxes.
    pub boxes: Vec<BoundingBox3D>,
    /// What class numbers mean.
    #[serde(default, skip_serializing_if = "Classes::is_empty")]
    pub classes: Classes,
    /// How to move to see better.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

target!(BoundingBox3DList, |list| Some(mean(list.boxes.iter().map(|found| found.confidence))));

impl From<Vec<BoundingBox3D>> for BoundingBox3DList {
    fn from(boxes: Vec<BoundingBox3D>) -> Self {
        Self { boxes, ..Self::default() }
    }
}

impl fmt::Display for BoundingBox3DList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !f.alternate() {
            return self.kitti().fmt(f);
        }
        for found in &self.boxes {
            self.classes.write_label(&found.name, f)?;
            found.write_place(f)?;
            writeln!(f)?;
        }
        Ok(())
    }
}
