//! Forces that oppose a velocity up to a limit: the friction of the table, and servo motors.

use super::vector::Velocity;

/// A velocity that is held by limited forces.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Drive {
    /// Held velocity: m/s, rad/s, and m/s of the slide.
    pub target: Velocity,
    /// Largest force, N.
    pub force: f64,
    /// Length by which a torque is compared with a force, m: their limit surface is an ellipsoid.
    pub length: f64,
    /// Largest force of the slide, N.
    pub slide_force: f64,
}

impl Drive {
    /// Returns the friction of a table below a body.
    ///
    /// `length` is the mean distance of the area from the centre of friction under even pressure (Goyal, Ruina and Papadopoulos, 1991).
    pub fn table_friction(coefficient: f64, mass: f64, length: f64) -> Self {
        Self { force: coefficient * mass * 9.81, length, ..Self::default() }
    }
}
