//! An object as KITTI's rules look at it.

use opendr_engine::target::{BoundingBox3D, BoundingBox3DList, Name};
use opendr_engine::{Error, Result};

use super::rules::ObjectKind;
use crate::StandingBox;

/// An object of truth or answer.
#[derive(Debug, Clone, PartialEq)]
pub struct KittiObject {
    /// Type as in KITTI's files, e.g. `Car`, `Person_sitting` or `DontCare`; case does not matter.
    pub class: String,
    /// Share that lies outside the picture; only of truth.
    pub truncated: f64,
    /// 0 visible, 1 partly, 2 largely hidden, 3 not known; only of truth.
    pub occluded: i32,
    /// Angle under which it is seen, radians; -10 when it is not known.
    pub alpha: f64,
    /// Corners `[x0, y0, x1, y1]` in the picture, pixels.
    pub in_image: [f64; 4],
    /// Length, height and width, metres.
    pub dimensions: [f64; 3],
    /// The middle of its floor in the camera's frame, metres.
    pub location: [f64; 3],
    /// Turn about the vertical axis, radians.
    pub rotation_y: f64,
    /// Score; only of answers.
    pub score: f64,
}

impl KittiObject {
    /// The box in space.
    pub fn standing_box(&self) -> StandingBox {
        StandingBox::in_camera(self.dimensions, self.location, self.rotation_y)
    }

    pub(super) fn kind(&self) -> ObjectKind {
        ObjectKind::from_name(&self.class)
    }

    /// Height in the picture, pixels.
    pub(super) fn height_in_image(&self) -> f64 {
        self.in_image[3] - self.in_image[1]
    }

    pub(super) fn check(&self) -> Result<()> {
        let numbers = [self.truncated, self.alpha, self.rotation_y, self.score].into_iter();
        let places = self.in_image.into_iter().chain(self.dimensions).chain(self.location);
        if numbers.chain(places).all(f64::is_finite) {
            return Ok(());
        }
        Err(Error::invalid_input(format!(
            "a {} has numbers that are not finite: {self:?}; give finite ones",
            self.class
        )))
    }
}

/// The objects of a list.
pub(super) fn objects_from_list(list: &BoundingBox3DList) -> Result<Vec<KittiObject>> {
    list.boxes.iter().map(|found| object_from_box(found, list)).collect()
}

fn object_from_box(found: &BoundingBox3D, list: &BoundingBox3DList) -> Result<KittiObject> {
    let class = match (list.classes.label(&found.name), &found.name) {
        (Some(label), _) => label.to_owned(),
        (None, Name::Label(label)) => label.to_string(),
        (None, Name::Index(index)) => {
            return Err(Error::invalid_input(format!(
                "a box has class number {index}, but its list names no classes; give labels such as \"Car\""
            )));
        }
    };
    if found.bbox2d == [0.0; 4] {
        return Err(Error::invalid_input(format!(
            "a {class} has no place in the picture (\"bbox2d\"), which KITTI's rules look at; project it into the picture"
        )));
    }
    Ok(KittiObject {
        class,
        truncated: as_written(found.truncated),
        occluded: found.occluded,
        alpha: as_written(found.alpha),
        in_image: found.bbox2d.map(as_written),
        dimensions: found.dimensions.map(as_written),
        location: found.location.map(as_written),
        rotation_y: as_written(found.rotation_y),
        score: as_written(found.confidence),
    })
}

/// The number that KITTI's file has: its two decimals lie on the rules' limits (0.15, 25 pixels), and an `f32` would
/// fall on either side of them.
fn as_written(number: f32) -> f64 {
    number.to_string().parse().unwrap_or_else(|_| f64::from(number))
}
