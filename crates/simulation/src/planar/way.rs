//! Ways around a body.

use super::vector::{Vector2, cross, dot, left, norm, plus, unit};

/// A circle that a way does not enter.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ring {
    pub centre: Vector2,
    pub radius: f64,
    /// Sense in which it is passed: 1 counter-clockwise, -1 clockwise.
    pub sense: f64,
}

/// How far a straight way may cut into the ring, m.
const CUT: f64 = 0.006;
/// How fast a way returns to the ring, per m of distance from it.
const RETURN: f64 = 40.0;

impl Ring {
    /// Returns the sense of the shorter way between two places, and the cosine of the angle between them.
    pub fn shorter(centre: Vector2, from: Vector2, to: Vector2) -> (f64, f64) {
        let (from, to) = (plus(from, centre, -1.0), plus(to, centre, -1.0));
        (cross(from, to).signum(), dot(unit(from), unit(to)))
    }

    /// Returns the unit direction from one place to another: straight on where that does not cross the ring, else along it.
    pub fn direction(&self, from: Vector2, to: Vector2) -> Vector2 {
        let (inner, outer) = (plus(from, self.centre, -1.0), plus(to, self.centre, -1.0));
        let line = plus(outer, inner, -1.0);
        let share = (-dot(inner, line) / dot(line, line).max(1e-12)).clamp(0.0, 1.0);
        let nearest = norm(plus(inner, line, share));
        let same_sense = cross(inner, outer) * self.sense >= 0.0;
        if nearest > self.radius - CUT && (same_sense || share == 0.0 && norm(inner) > 1.5 * self.radius) {
            return unit(line);
        }
        let outward = unit(inner);
        let tangent = left(outward).map(|part| part * self.sense);
        unit(plus(tangent, outward, ((self.radius - norm(inner)) * RETURN).clamp(-1.0, 1.0)))
    }
}
