//! Packets of rays.

use super::{Body, Directions, LANES, Vector};

/// Rays from one point with their nearest hits so far.
#[derive(Debug, Clone)]
pub(super) struct RayPacket {
    origin: Vector,
    directions: Directions,
    pub distances: [f32; LANES],
    pub bodies: [u32; LANES],
}

impl RayPacket {
    /// Creates rays along unit vectors, at most [`LANES`], with a length of `range` metres.
    pub fn new(origin: Vector, directions: &[Vector], range: f32) -> Self {
        let mut own = [[0.0; LANES], [0.0; LANES], [1.0; LANES]];
        for (lane, direction) in directions.iter().take(LANES).enumerate() {
            for axis in 0..3 {
                own[axis][lane] = direction[axis];
            }
        }
        Self { origin, directions: own, distances: [range; LANES], bodies: [u32::MAX; LANES] }
    }

    /// Updates the nearest hits with a body.
    pub fn meet(&mut self, body: &Body, number: u32) {
        let axes =
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| body.direction_in_body(axis));
        let mut directions = [[0.0; LANES]; 3];
        for (row, own) in directions.iter_mut().enumerate() {
            for lane in 0..LANES {
                let [x, y, z] = self.directions.each_ref().map(|axis| axis[lane]);
                own[lane] = axes[0][row] * x + axes[1][row] * y + axes[2][row] * z;
            }
        }
        let before = self.distances;
        body.shape().meet(body.point_in_body(self.origin), &directions, &mut self.distances);
        for ((body, distance), before) in self.bodies.iter_mut().zip(self.distances).zip(before) {
            *body = if distance < before { number } else { *body };
        }
    }
}
