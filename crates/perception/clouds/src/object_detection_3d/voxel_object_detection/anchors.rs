//! Anchors in space: the boxes that a detector starts from (Lang et al., PointPillars, CVPR 2019, section 4.1).

use opendr_engine::target::LidarBox;
use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

/// The same box in the middle of every cell.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AnchorKind {
    /// The number of its class.
    pub class: usize,
    /// Length, width and height, metres.
    pub size: [f32; 3],
    /// Height of its floor in the lidar's frame, metres.
    pub z: f32,
    /// Where its front looks, radians.
    pub yaw: f32,
}

/// Names, sizes and floors of KITTI's classes: length, width, height, and height of the floor, metres.
const CLASSES: [(&str, [f32; 3], f32); 3] = [
    ("Car", [3.9, 1.6, 1.56], -1.7),
    ("Pedestrian", [0.8, 0.6, 1.73], -1.7),
    ("Cyclist", [1.76, 0.6, 1.73], -1.7),
];

/// Most kinds, and metres of a side, that a container may ask for.
const MOST_KINDS: usize = 64;
const LARGEST: f32 = 1000.0;

impl AnchorKind {
    /// Two kinds of a class of KITTI's, one along each axis; `class` is its number.
    ///
    /// # Errors
    /// `InvalidParam` for a name that is none of `Car`, `Pedestrian` and `Cyclist`.
    pub fn of_class(name: &str, class: usize) -> Result<[Self; 2]> {
        let Some((_, size, z)) = CLASSES.iter().find(|(label, ..)| label.eq_ignore_ascii_case(name)) else {
            return Err(Error::invalid_param(format!(
                "there are anchors for Car, Pedestrian and Cyclist, none for {name:.40?}"
            )));
        };
        Ok([0.0, std::f32::consts::FRAC_PI_2].map(|yaw| Self { class, size: *size, z: *z, yaw }))
    }

    /// The anchor about a place on the ground.
    pub fn at(&self, [x, y]: [f32; 2]) -> LidarBox {
        let center = [x, y, self.z].map(f64::from);
        LidarBox { center, size: self.size.map(f64::from), yaw: f64::from(self.yaw) }
    }

    /// Checks what a container says.
    ///
    /// # Errors
    /// `Format` when there is no kind or far too many, or a number makes no sense.
    pub fn check(kinds: &[Self], classes: usize) -> Result<()> {
        let sane = |kind: &Self| {
            kind.class < classes
                && kind.size.iter().all(|side| *side > 0.0 && *side < LARGEST)
                && kind.z.abs() < LARGEST
                && kind.yaw.abs() < 7.0
        };
        if (1..=MOST_KINDS).contains(&kinds.len()) && kinds.iter().all(sane) {
            return Ok(());
        }
        Err(Error::format(format!(
            "anchors are 1 to {MOST_KINDS} boxes of {classes} classes with sides within 0 and {LARGEST} metres; the model \
             says {kinds:?}"
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cars_lie_along_both_axes() {
        let kinds = AnchorKind::of_class("car", 2).unwrap();
        AnchorKind::check(&kinds, 3).unwrap();
        assert!(AnchorKind::check(&kinds, 2).is_err() && AnchorKind::check(&[], 2).is_err());
        assert!(AnchorKind::check(&[AnchorKind { size: [f32::NAN; 3], ..kinds[0] }], 3).is_err());
        assert!(AnchorKind::of_class("Tram", 0).is_err());
        let anchor = kinds[1].at([3.0, -2.0]);
        assert_eq!(anchor.center[..2], [3.0, -2.0]);
        assert!((anchor.yaw - std::f64::consts::FRAC_PI_2).abs() < 1e-4);
    }
}
