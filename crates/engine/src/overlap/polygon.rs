//! Clipping of convex polygons.

/// A convex polygon of at most eight corners: four, and one more per clipping line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Polygon {
    corners: [[f64; 2]; 8],
    len: usize,
}

impl Polygon {
    pub fn new(corners: [[f64; 2]; 4]) -> Self {
        let mut all = [[0.0; 2]; 8];
        all[..4].copy_from_slice(&corners);
        Self { corners: all, len: 4 }
    }

    fn push(&mut self, corner: [f64; 2]) {
        if let Some(place) = self.corners.get_mut(self.len) {
            *place = corner;
            self.len += 1;
        }
    }

    /// Returns the part where `sign` times the coordinate along `axis` is at most `limit`.
    pub fn below(&self, axis: usize, limit: f64, sign: f64) -> Self {
        let mut clipped = Self { len: 0, ..*self };
        let corners = &self.corners[..self.len];
        let nexts = corners.iter().cycle().skip(1);
        for (corner, next) in corners.iter().zip(nexts) {
            let (here, there) = (sign * corner[axis], sign * next[axis]);
            if here <= limit {
                clipped.push(*corner);
            }
            if (here <= limit) != (there <= limit) {
                let share = (limit - here) / (there - here);
                let other = 1 - axis;
                let mut crossing = [0.0; 2];
                crossing[axis] = sign * limit;
                crossing[other] = corner[other] + share * (next[other] - corner[other]);
                clipped.push(crossing);
            }
        }
        clipped
    }

    /// Returns the part on the side of the line from `begin` to `end` where the cross product with the direction is not negative.
    pub fn beside(&self, begin: [f64; 2], end: [f64; 2]) -> Self {
        let direction = [end[0] - begin[0], end[1] - begin[1]];
        let side =
            |corner: &[f64; 2]| direction[0] * (corner[1] - begin[1]) - direction[1] * (corner[0] - begin[0]);
        let mut clipped = Self { len: 0, ..*self };
        let corners = &self.corners[..self.len];
        let nexts = corners.iter().cycle().skip(1);
        for (corner, next) in corners.iter().zip(nexts) {
            let (here, there) = (side(corner), side(next));
            if here >= 0.0 {
                clipped.push(*corner);
            }
            if (here >= 0.0) != (there >= 0.0) {
                let share = here / (here - there);
                let crossing = [0, 1].map(|axis| corner[axis] + share * (next[axis] - corner[axis]));
                clipped.push(crossing);
            }
        }
        clipped
    }

    /// Returns the area by the shoelace formula.
    pub fn area(&self) -> f64 {
        let corners = &self.corners[..self.len];
        let nexts = corners.iter().cycle().skip(1);
        let doubled: f64 = corners.iter().zip(nexts).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
        doubled.abs() / 2.0
    }
}
