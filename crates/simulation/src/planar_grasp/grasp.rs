//! A planar grasp.

use super::{HALF_VIEW, MAX_WIDTH};

/// A grasp of a parallel gripper from above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grasp {
    /// Middle between the jaws on the table, m.
    pub place: [f64; 2],
    /// Direction in which the jaws close, rad to the left of the x-axis; a half turn makes no difference.
    pub angle: f64,
    /// Distance of the jaws before they close, m.
    pub width: f64,
}

impl Grasp {
    /// Returns the grasp of an action in [-1, 1]: x and y over half the view, the angle over a right angle, and the width from 0 to
    /// the widest.
    pub fn of_action([x, y, angle, width]: [f32; 4]) -> Self {
        Self {
            place: [x, y].map(|part| HALF_VIEW * f64::from(part)),
            angle: std::f64::consts::FRAC_PI_2 * f64::from(angle),
            width: MAX_WIDTH * 0.5 * (f64::from(width) + 1.0),
        }
    }

    /// Returns the action of the grasp, cut to its range.
    pub fn action(&self) -> [f32; 4] {
        let right_angle = std::f64::consts::FRAC_PI_2;
        let half_turn = std::f64::consts::PI;
        let angle = self.angle - half_turn * ((self.angle + right_angle) / half_turn).floor();
        let [x, y] = self.place.map(|part| part / HALF_VIEW);
        [x, y, angle / right_angle, 2.0 * self.width / MAX_WIDTH - 1.0]
            .map(|part| part.clamp(-1.0, 1.0) as f32)
    }

    /// Returns distance, m, and angle, rad in [0, pi/2], between two grasps.
    pub fn difference(&self, other: &Self) -> (f64, f64) {
        let [x, y] = [0, 1].map(|axis| self.place[axis] - other.place[axis]);
        let half_turn = std::f64::consts::PI;
        let turn = (self.angle - other.angle).rem_euclid(half_turn);
        ((x * x + y * y).sqrt(), turn.min(half_turn - turn))
    }
}
