//! Kalman filter of a 3D box.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use opendr_engine::overlap::UprightBox3D;
use opendr_engine::target::BoundingBox3D;

use crate::tracking::{Constant, ConstantVelocity};

/// AB3DMOT's state of ten numbers: position with velocity, rotation and size, in the camera's frame, in metres and radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BoxFilter {
    location: [ConstantVelocity; 3],
    rotation: Constant,
    dimensions: [Constant; 3],
}

/// The paper's variances: velocities are unknown at first.
const START: [f64; 2] = [10.0, 1e4];
const MOTION: [f64; 2] = [1.0, 0.01];
const MEASURED: f64 = 1.0;

impl BoxFilter {
    pub fn new(found: &BoundingBox3D) -> Self {
        let constant = |number: f32| Constant::new(f64::from(number), START[0]);
        Self {
            location: found.location.map(|at| ConstantVelocity::new(f64::from(at), START)),
            rotation: Constant::new(wrapped(f64::from(found.rotation_y)), START[0]),
            dimensions: found.dimensions.map(constant),
        }
    }

    /// Advances by one step.
    pub fn predict(&mut self) {
        self.location.iter_mut().for_each(|axis| axis.predict(MOTION));
        self.rotation.predict(MOTION[0]);
        self.dimensions.iter_mut().for_each(|side| side.predict(MOTION[0]));
    }

    /// Updates with a detection. A detection rotated by more than a quarter turn counts as reversed: detectors confuse
    /// front and back.
    pub fn update(&mut self, found: &BoundingBox3D) {
        for (axis, at) in self.location.iter_mut().zip(found.location) {
            axis.update(f64::from(at), MEASURED);
        }
        for (side, length) in self.dimensions.iter_mut().zip(found.dimensions) {
            side.update(f64::from(length), MEASURED);
        }
        let measured = f64::from(found.rotation_y);
        if wrapped(measured - self.rotation.value).abs() > FRAC_PI_2 {
            self.rotation.value += PI;
        }
        let nearest = self.rotation.value + wrapped(measured - self.rotation.value);
        self.rotation.update(nearest, MEASURED);
        self.rotation.value = wrapped(self.rotation.value);
    }

    pub fn standing_box(&self) -> UprightBox3D {
        let dimensions = self.dimensions.map(|side| side.value);
        UprightBox3D::from_kitti(dimensions, self.location.map(|axis| axis.position), self.rotation.value)
    }

    /// Returns `found` with the filter's position, rotation and size.
    pub fn place(&self, found: &BoundingBox3D) -> BoundingBox3D {
        BoundingBox3D {
            dimensions: self.dimensions.map(|side| side.value as f32),
            location: self.location.map(|axis| axis.position as f32),
            rotation_y: self.rotation.value as f32,
            ..found.clone()
        }
    }
}

/// Wraps an angle to -pi..=pi.
fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}
