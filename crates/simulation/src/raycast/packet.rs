//! Several rays at once.

use super::shape::Directions;
use super::{Body, Vector};

/// Rays of a packet: one vector register of AVX-512, two of AVX2, four of NEON.
pub const LANES: usize = 16;

/// Rays from one point, with what they have met so far.
#[derive(Debug, Clone)]
pub struct RayPacket {
    origin: Vector,
    directions: Directions,
    pub(super) distances: [f32; LANES],
    pub(super) bodies: [u32; LANES],
}

impl RayPacket {
    /// Rays along unit vectors, at most [`LANES`]; they see `range` metres far.
    pub fn new(origin: Vector, directions: &[Vector], range: f32) -> Self {
        let mut own = [[0.0; LANES], [0.0; LANES], [1.0; LANES]];
        for (lane, direction) in directions.iter().take(LANES).enumerate() {
            for axis in 0..3 {
                own[axis][lane] = direction[axis];
            }
        }
        Self { origin, directions: own, distances: [range; LANES], bodies: [u32::MAX; LANES] }
    }

    /// Keeps what is nearer than all before.
    pub(super) fn meet(&mut self, body: &Body, number: u32) {
        let mut directions = [[0.0; LANES]; 3];
        for (own, row) in directions.iter_mut().zip(body.body_from_world()) {
            for lane in 0..LANES {
                let [x, y, z] = self.directions.each_ref().map(|axis| axis[lane]);
                own[lane] = row[0] * x + row[1] * y + row[2] * z;
            }
        }
        let mut distances = [0.0; LANES];
        body.shape().meet(body.point_in_body(self.origin), &directions, &mut distances);
        let best = self.distances.iter_mut().zip(&mut self.bodies);
        for ((best, nearest), distance) in best.zip(distances) {
            let nearer = distance < *best;
            *nearest = if nearer { number } else { *nearest };
            *best = if nearer { distance } else { *best };
        }
    }
}
