//! Rounded convex polygons and the distance of points from them.

use super::vector::{Vector2, cross, dot, left, norm, plus, turned, unit};

/// Most corners of a polygon.
pub(crate) const MAX_CORNERS: usize = 8;

/// A convex polygon with its corners counter-clockwise, grown by a radius on all sides. One corner makes a disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Convex {
    corners: [Vector2; MAX_CORNERS],
    count: usize,
    pub radius: f64,
}

/// The nearest place of a polygon to a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearest {
    pub point: Vector2,
    /// Unit vector from the polygon to the point.
    pub normal: Vector2,
    /// Distance, negative inside.
    pub distance: f64,
}

impl Convex {
    pub fn disc(radius: f64) -> Self {
        Self { corners: [[0.0; 2]; MAX_CORNERS], count: 1, radius }
    }

    /// Returns an upright rectangle of `half` sizes about `centre`.
    pub fn rectangle(centre: Vector2, half: Vector2) -> Self {
        let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        Self::polygon(&signs.map(|[x, y]| [centre[0] + x * half[0], centre[1] + y * half[1]]))
    }

    /// Returns a polygon of up to [`MAX_CORNERS`] corners, counter-clockwise; further ones are left out.
    pub fn polygon(points: &[Vector2]) -> Self {
        let mut corners = [[0.0; 2]; MAX_CORNERS];
        let count = points.len().min(MAX_CORNERS);
        corners.iter_mut().zip(points).for_each(|(corner, point)| *corner = *point);
        Self { corners, count, radius: 0.0 }
    }

    pub fn corners(&self) -> &[Vector2] {
        &self.corners[..self.count]
    }

    /// Returns the polygon turned, then moved.
    pub fn placed(&self, place: Vector2, turn: (f64, f64)) -> Self {
        let mut moved = *self;
        moved.corners[..self.count]
            .iter_mut()
            .for_each(|corner| *corner = plus(place, turned(*corner, turn), 1.0));
        moved
    }

    /// Returns the corner-to-corner edges; none of a disc.
    pub fn edges(&self) -> impl Iterator<Item = [Vector2; 2]> + '_ {
        let corners = self.corners();
        let edges = if corners.len() > 1 { corners.len() } else { 0 };
        (0..edges).map(move |at| [corners[at], corners[(at + 1) % corners.len()]])
    }

    /// Returns the nearest place of the polygon, without its radius.
    pub(super) fn nearest(&self, point: Vector2) -> Nearest {
        let from = |place: Vector2| {
            let away = plus(point, place, -1.0);
            Nearest { point: place, normal: unit(away), distance: norm(away) }
        };
        let mut deepest: Option<Nearest> = None;
        let mut outside: Option<Nearest> = None;
        for [start, end] in self.edges() {
            let along = plus(end, start, -1.0);
            let (length, aside) = (norm(along), plus(point, start, -1.0));
            let normal = left(along).map(|part| -part / length);
            let distance = dot(normal, aside);
            let share = (dot(along, aside) / (length * length)).clamp(0.0, 1.0);
            let place = plus(start, along, share);
            if distance > 0.0 {
                let candidate = from(place);
                if outside.is_none_or(|best| candidate.distance < best.distance) {
                    outside = Some(candidate);
                }
            } else if deepest.is_none_or(|best| distance > best.distance) {
                deepest = Some(Nearest { point: place, normal, distance });
            }
        }
        outside.or(deepest).unwrap_or_else(|| from(self.corners[0]))
    }

    /// Returns the signed distance of a point from the rounded polygon.
    pub fn distance(&self, point: Vector2) -> f64 {
        self.nearest(point).distance - self.radius
    }

    /// Returns area, first and second moments (polar) of the polygon about the origin, without its radius.
    pub fn moments(&self) -> (f64, Vector2, f64) {
        let (mut area, mut first, mut second) = (0.0, [0.0; 2], 0.0);
        for [a, b] in self.edges() {
            let twice = cross(a, b);
            area += twice / 2.0;
            first = plus(first, plus(a, b, 1.0), twice / 6.0);
            second += twice * (dot(a, a) + dot(a, b) + dot(b, b)) / 12.0;
        }
        (area, first, second)
    }
}
