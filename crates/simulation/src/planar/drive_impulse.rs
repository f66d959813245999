//! The impulses by which a drive holds its velocity.

use super::body::Body;
use super::vector::norm;

/// Impulses of a drive in a step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct DriveImpulse([f64; 4]);

impl DriveImpulse {
    /// Reduces the difference from the held velocity. Steps are scaled by `mass * length^2` about the vertical: at the fixed point the
    /// velocity is normal to the ellipsoid of forces, the law of greatest dissipation.
    pub fn solve(&mut self, body: &mut Body, seconds: f64) {
        let (mass, drive) = (body.mass, body.drive);
        if drive.force > 0.0 {
            let off = |at: usize| body.velocity[at] - drive.target[at];
            let length = drive.length.max(1e-6);
            // Forces along x and y, and the torque over the length.
            let wanted =
                [self.0[0] - mass * off(0), self.0[1] - mass * off(1), self.0[2] - mass * length * off(2)];
            let size = norm([norm([wanted[0], wanted[1]]), wanted[2]]);
            let scale = (drive.force * seconds / size.max(1e-12)).min(1.0);
            let change: [f64; 3] = std::array::from_fn(|at| wanted[at] * scale - self.0[at]);
            (0..3).for_each(|at| self.0[at] += change[at]);
            body.velocity[0] += change[0] / mass;
            body.velocity[1] += change[1] / mass;
            body.velocity[2] += change[2] * length / body.inertia;
        }
        if drive.slide_force > 0.0 {
            let limit = drive.slide_force * seconds;
            let wanted = self.0[3] - body.slide_mass * (body.velocity[3] - drive.target[3]);
            let change = wanted.clamp(-limit, limit) - self.0[3];
            self.0[3] += change;
            body.velocity[3] += change / body.slide_mass;
        }
    }
}
