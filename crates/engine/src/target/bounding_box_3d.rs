//! Bounding boxes in space, for 3D detection.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::Header;
use crate::target::json_number::null_as_nan;
use crate::target::{Action, Classes, Name, mean};

/// A 3D bounding box in the camera frame of KITTI: x right, y down, z forward.
///
/// `{}` writes OpenDR's text (`kitti()`), `{:#}` a readable line.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BoundingBox3D {
    /// Class index or label.
    pub name: Name,
    /// Fraction of the object outside the image, 0..=1; -1 if unknown.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub truncated: f32,
    /// Occlusion: 0 visible, 1 partly occluded, 2 mostly occluded, 3 or -1 unknown.
    #[serde(default)]
    pub occluded: i32,
    /// Observation angle of the object, radians in [-pi, pi].
    #[serde(default, deserialize_with = "null_as_nan")]
    pub alpha: f32,
    /// Bounding box in the image, corners `[x0, y0, x1, y1]` in pixels.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub bbox2d: [f32; 4],
    /// Length, height and width in metres: OpenDR's order, not that of KITTI's files.
    #[serde(deserialize_with = "null_as_nan")]
    pub dimensions: [f32; 3],
    /// Center of the base, x, y, z in metres.
    #[serde(deserialize_with = "null_as_nan")]
    pub location: [f32; 3],
    /// Rotation about the vertical axis, radians in [-pi, pi]; at 0 the object faces along x.
    #[serde(deserialize_with = "null_as_nan")]
    pub rotation_y: f32,
    /// Score.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub confidence: f32,
}

impl BoundingBox3D {
    /// Writes score and position, after the label of a readable line.
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

/// The 3D bounding boxes in a point cloud or image.
///
/// `{}` writes OpenDR's text (`kitti()`), `{:#}` a readable line per box.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BoundingBox3DList {
    /// Header of the point cloud or image.
    #[serde(flatten)]
    pub header: Header,
    /// The boxes.
    pub boxes: Vec<BoundingBox3D>,
    /// Class names.
    #[serde(default, skip_serializing_if = "Classes::is_empty")]
    pub classes: Classes,
    /// Proposed camera motion for a better view.
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
