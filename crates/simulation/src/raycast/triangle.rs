//! One triangle of a mesh.

use super::{Directions, LANES, Vector, along, cross, dot, minus};

/// A corner and the two edges from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Triangle {
    corner: Vector,
    edges: [Vector; 2],
}

impl Triangle {
    pub fn new([a, b, c]: [Vector; 3]) -> Self {
        Self { corner: a, edges: [minus(b, a), minus(c, a)] }
    }

    pub fn corners(&self) -> [Vector; 3] {
        let [ab, ac] = self.edges;
        [self.corner, along(self.corner, ab, 1.0), along(self.corner, ac, 1.0)]
    }

    /// Returns the normal on the side from which the corners are counter-clockwise; not normalised.
    pub fn normal(&self) -> Vector {
        cross(self.edges[0], self.edges[1])
    }

    /// Shortens the rays that hit it (Möller and Trumbore, Fast, minimum storage ray/triangle intersection, 1997).
    #[inline(always)]
    pub fn meet(&self, origin: Vector, directions: &Directions, distances: &mut [f32; LANES]) {
        let [ab, ac] = self.edges;
        let from_corner = minus(origin, self.corner);
        let moment = cross(from_corner, ab);
        let ahead = dot(ac, moment);
        for lane in 0..LANES {
            let direction = [directions[0][lane], directions[1][lane], directions[2][lane]];
            let across = cross(direction, ac);
            let inverse = 1.0 / dot(ab, across);
            let u = dot(from_corner, across) * inverse;
            let v = dot(direction, moment) * inverse;
            let distance = ahead * inverse;
            // With a margin, so that no ray passes between two triangles.
            let inside = (u >= -1e-6) & (v >= -1e-6) & (u + v <= 1.000_001);
            let meets = inside & (distance > 0.0) & (distance < distances[lane]);
            distances[lane] = if meets { distance } else { distances[lane] };
        }
    }

    /// Returns its point nearest to `point` (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
    pub fn nearest(&self, point: Vector) -> Vector {
        let [ab, ac] = self.edges;
        let from_a = minus(point, self.corner);
        let (d1, d2) = (dot(ab, from_a), dot(ac, from_a));
        if d1 <= 0.0 && d2 <= 0.0 {
            return self.corner;
        }
        let from_b = minus(from_a, ab);
        let (d3, d4) = (dot(ab, from_b), dot(ac, from_b));
        if d3 >= 0.0 && d4 <= d3 {
            return along(self.corner, ab, 1.0);
        }
        let from_c = minus(from_a, ac);
        let (d5, d6) = (dot(ab, from_c), dot(ac, from_c));
        if d6 >= 0.0 && d5 <= d6 {
            return along(self.corner, ac, 1.0);
        }
        let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
        if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            return along(self.corner, ab, d1 / (d1 - d3));
        }
        if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            return along(self.corner, ac, d2 / (d2 - d6));
        }
        if va <= 0.0 && d4 >= d3 && d5 >= d6 {
            let part = (d4 - d3) / ((d4 - d3) + (d5 - d6));
            return along(along(self.corner, ab, 1.0), minus(ac, ab), part);
        }
        let inverse = 1.0 / (va + vb + vc);
        along(along(self.corner, ab, vb * inverse), ac, vc * inverse)
    }
}
