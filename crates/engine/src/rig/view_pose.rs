//! Where a camera is on the sphere around its subject.

use serde::{Deserialize, Serialize};

/// A place on a sphere around the subject, from which the camera looks at it.
///
/// The subject's frame has x to the front, y to the left, z up (REP 103).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewPose {
    /// Angle about z from the x axis, counter-clockwise, in rad.
    pub azimuth: f64,
    /// Angle above the horizontal plane, in rad.
    pub elevation: f64,
    /// Distance from the subject; its unit is the rig's.
    pub distance: f64,
    /// Roll about the optical axis in rad, or magnification, whichever the fourth axis of the rig is.
    #[serde(default)]
    pub fourth: f64,
}

impl ViewPose {
    /// Returns the direction from the subject to the camera, length 1.
    pub fn direction(&self) -> [f64; 3] {
        let (sine, cosine) = self.elevation.sin_cos();
        [cosine * self.azimuth.cos(), cosine * self.azimuth.sin(), sine]
    }

    /// Returns the position of the camera in the subject's frame.
    pub fn position(&self) -> [f64; 3] {
        self.direction().map(|part| part * self.distance)
    }

    /// Returns the angle between the directions of two views, 0 to pi.
    pub fn angle_to(&self, other: &Self) -> f64 {
        let (a, b) = (self.direction(), other.direction());
        // The half angle from the chord: the arc cosine loses half of the digits of small angles.
        let chord = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        2.0 * (chord / 2.0).min(1.0).asin()
    }
}
