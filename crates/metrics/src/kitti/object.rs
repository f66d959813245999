//! Objects with the properties that KITTI's rules use.

use opendr_engine::target::{BoundingBox3D, BoundingBox3DList, Name};
use opendr_engine::{Error, Result};

use super::rules::{ObjectKind, Traits};
use crate::UprightBox3D;

/// A ground-truth or predicted object.
#[derive(Debug, Clone, PartialEq)]
pub struct KittiObject {
    /// Type as in KITTI's files, e.g. `Car`, `Person_sitting` or `DontCare`; case does not matter.
    pub class: String,
    /// Fraction outside the image; ground truth only.
    pub truncated: f64,
    /// Occlusion: 0 visible, 1 partly, 2 largely occluded, 3 unknown; ground truth only.
    pub occluded: i32,
    /// Observation angle in radians; -10 if unknown.
    pub alpha: f64,
    /// Corners `[x0, y0, x1, y1]` in the image, in pixels.
    pub bbox2d: [f64; 4],
    /// Length, height and width in metres.
    pub dimensions: [f64; 3],
    /// Center of the base in the camera frame, in metres.
    pub location: [f64; 3],
    /// Rotation about the vertical axis, in radians.
    pub rotation_y: f64,
    /// Score; predictions only.
    pub score: f64,
}

impl KittiObject {
    /// Returns the 3D box.
    pub fn upright_box(&self) -> UprightBox3D {
        UprightBox3D::from_kitti(self.dimensions, self.location, self.rotation_y)
    }

    pub(super) fn kind(&self) -> ObjectKind {
        ObjectKind::from_name(&self.class)
    }

    /// Returns the height in the image, in pixels.
    pub(super) fn height_in_image(&self) -> f64 {
        self.bbox2d[3] - self.bbox2d[1]
    }

    pub(super) fn check(&self) -> Result<()> {
        let numbers = [self.truncated, self.alpha, self.rotation_y, self.score].into_iter();
        let places = self.bbox2d.into_iter().chain(self.dimensions).chain(self.location);
        if numbers.chain(places).all(f64::is_finite) {
            return Ok(());
        }
        Err(Error::invalid_input(format!(
            "a {} has numbers that are not finite: {self:?}; give finite numbers",
            self.class
        )))
    }
}

impl From<&KittiObject> for Traits {
    fn from(object: &KittiObject) -> Self {
        let KittiObject { truncated, occluded, .. } = *object;
        Self { kind: object.kind(), height: object.height_in_image(), truncated, occluded }
    }
}

/// Converts a list of boxes to objects.
pub(super) fn objects_from_list(list: &BoundingBox3DList) -> Result<Vec<KittiObject>> {
    list.boxes.iter().map(|found| object_from_box(found, list)).collect()
}

fn object_from_box(found: &BoundingBox3D, list: &BoundingBox3DList) -> Result<KittiObject> {
    let class = match (list.classes.label(&found.name), &found.name) {
        (Some(label), _) => label.to_owned(),
        (None, Name::Label(label)) => label.to_string(),
        (None, Name::Index(index)) => {
            return Err(Error::invalid_input(format!(
                "a box has class index {index}, but its list has no class names; give labels such as \"Car\""
            )));
        }
    };
    if found.bbox2d == [0.0; 4] {
        return Err(Error::invalid_input(format!(
            "a {class} has no box in the image (\"bbox2d\"), which KITTI's rules need; project it into the image"
        )));
    }
    Ok(KittiObject {
        class,
        truncated: as_written(found.truncated),
        occluded: found.occluded,
        alpha: as_written(found.alpha),
        bbox2d: found.bbox2d.map(as_written),
        dimensions: found.dimensions.map(as_written),
        location: found.location.map(as_written),
        rotation_y: as_written(found.rotation_y),
        score: as_written(found.confidence),
    })
}

/// Returns the decimal number in KITTI's file. Its two decimals may equal the limits of the rules (0.15, 25 pixels), and an
/// `f32` could be on either side of them.
fn as_written(number: f32) -> f64 {
    number.to_string().parse().unwrap_or_else(|_| f64::from(number))
}
