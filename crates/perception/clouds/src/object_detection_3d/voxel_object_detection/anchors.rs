//! Anchors of 3D boxes (Lang et al., PointPillars, CVPR 2019, section 4.1).

use opendr_engine::target::LidarBox;
use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

/// An anchor that is repeated at the centre of every cell.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AnchorKind {
    /// Class index.
    pub class: usize,
    /// Length, width and height in metres.
    pub size: [f32; 3],
    /// Height of the box's floor in the lidar's frame, in metres.
    pub z: f32,
    /// Yaw in radians.
    pub yaw: f32,
}

/// Names, sizes (length, width, height) and floor heights of KITTI's classes, in metres.
const CLASSES: [(&str, [f32; 3], f32); 3] = [
    ("Car", [3.9, 1.6, 1.56], -1.7),
    ("Pedestrian", [0.8, 0.6, 1.73], -1.7),
    ("Cyclist", [1.76, 0.6, 1.73], -1.7),
];

/// Maximum number of anchors per cell, and maximum side in metres, in a container.
const MOST_KINDS: usize = 64;
const LARGEST: f32 = 1000.0;

impl AnchorKind {
    /// Returns two anchors of a KITTI class, one along each axis; `class` is the class index.
    ///
    /// # Errors
    /// `InvalidParam` for a name other than `Car`, `Pedestrian` and `Cyclist`.
    pub fn of_class(name: &str, class: usize) -> Result<[Self; 2]> {
        let Some((_, size, z)) = CLASSES.iter().find(|(label, ..)| label.eq_ignore_ascii_case(name)) else {
            return Err(Error::invalid_param(format!(
                "no anchors for {name:.40?}; supported are Car, Pedestrian and Cyclist"
            )));
        };
        Ok([0.0, std::f32::consts::FRAC_PI_2].map(|yaw| Self { class, size: *size, z: *z, yaw }))
    }

    /// Returns the anchor at a position on the ground.
    pub fn at(&self, [x, y]: [f32; 2]) -> LidarBox {
        let center = [x, y, self.z].map(f64::from);
        LidarBox { center, size: self.size.map(f64::from), yaw: f64::from(self.yaw) }
    }

    /// Checks the anchors of a container.
    ///
    /// # Errors
    /// `Format` for no anchor, too many of them, or an invalid value.
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
            "a model must have 1 to {MOST_KINDS} anchors of {classes} classes with sides within 0 and {LARGEST} metres; this \
             one has {kinds:?}"
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
