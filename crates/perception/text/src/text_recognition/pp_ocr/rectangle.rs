//! The rectangle of least area around pixels, as OpenCV's `minAreaRect`.

/// A pixel: column and row.
pub type Pixel = [i64; 2];

/// Areas that differ by less than this share are equal.
const SAME_AREA: f64 = 1e-9;

/// A rotated rectangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle {
    /// Its centre.
    pub center: [f64; 2],
    /// The unit vector along its first side.
    pub axis: [f64; 2],
    /// Half the lengths of its sides: along the axis and across it.
    pub half: [f64; 2],
}

impl Rectangle {
    /// Returns the rectangle of least area around a convex polygon of [`convex_hull`], by rotating calipers. Of rectangles of equal area it is
    /// the one with the least tilt. `None` without points.
    pub fn around(hull: &[Pixel]) -> Option<Self> {
        let mut best = Self { center: to_point(*hull.first()?), axis: [1.0, 0.0], half: [0.0; 2] };
        if hull.len() == 1 {
            return Some(best);
        }
        let mut best_area = f64::INFINITY;
        let mut touching = Touching::default();
        for edge in 0..hull.len() {
            let candidate = touching.rectangle(hull, edge);
            let area = candidate.area();
            let tie = (area - best_area).abs() <= SAME_AREA * area;
            if if tie { candidate.tilt() < best.tilt() } else { area < best_area } {
                best = candidate;
                best_area = area;
            }
        }
        Some(best)
    }

    /// Its area.
    pub fn area(&self) -> f64 {
        4.0 * self.half[0] * self.half[1]
    }

    /// Returns the length of its outline.
    pub fn perimeter(&self) -> f64 {
        4.0 * (self.half[0] + self.half[1])
    }

    /// Returns the length of its shorter side.
    pub fn short_side(&self) -> f64 {
        2.0 * self.half[0].min(self.half[1])
    }

    /// Returns the rectangle with each side moved outwards by `distance`.
    pub fn grown(self, distance: f64) -> Self {
        Self { half: self.half.map(|half| half + distance), ..self }
    }

    /// Its corners, clockwise. The first is the upper one of the two leftmost.
    pub fn corners(&self) -> [[f64; 2]; 4] {
        let [x, y] = self.center;
        let along = self.axis.map(|value| value * self.half[0]);
        let across = [-self.axis[1] * self.half[1], self.axis[0] * self.half[1]];
        let mut corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(a, b)| [x + a * along[0] + b * across[0], y + a * along[1] + b * across[1]]);
        corners.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let [a, b, c, d] = corners;
        let (top_left, bottom_left) = if b[1] > a[1] { (a, b) } else { (b, a) };
        let (top_right, bottom_right) = if d[1] > c[1] { (c, d) } else { (d, c) };
        [top_left, top_right, bottom_right, bottom_left]
    }

    /// The tangent of the angle to the nearest axis of the map.
    fn tilt(&self) -> f64 {
        let [x, y] = self.axis.map(f64::abs);
        x.min(y) / x.max(y)
    }
}

/// The vertices of a hull that touch the sides of a rectangle on one of its edges. They only move forwards from edge to edge.
#[derive(Default)]
struct Touching {
    right: usize,
    far: usize,
    left: usize,
}

impl Touching {
    /// The rectangle with a side on an edge. Call it with the edges in order.
    fn rectangle(&mut self, hull: &[Pixel], edge: usize) -> Rectangle {
        let at = |index: usize| hull[index % hull.len()];
        let along = difference(at(edge + 1), at(edge));
        let step = |index: usize| difference(at(index + 1), at(index));
        self.right = self.right.max(edge + 1);
        while dot(along, step(self.right)) > 0 {
            self.right += 1;
        }
        self.far = self.far.max(self.right);
        while cross(along, step(self.far)) > 0 {
            self.far += 1;
        }
        self.left = self.left.max(self.far);
        while dot(along, step(self.left)) < 0 {
            self.left += 1;
        }
        let length = (dot(along, along) as f64).sqrt();
        let from_edge = |index: usize| difference(at(index), at(edge));
        let end = dot(along, from_edge(self.right)) as f64 / length;
        let start = dot(along, from_edge(self.left)) as f64 / length;
        let width = cross(along, from_edge(self.far)) as f64 / length;
        let axis = along.map(|value| value as f64 / length);
        let [x, y] = to_point(at(edge));
        let (middle, depth) = ((start + end) / 2.0, width / 2.0);
        Rectangle {
            center: [x + middle * axis[0] - depth * axis[1], y + middle * axis[1] + depth * axis[0]],
            axis,
            half: [(end - start) / 2.0, depth],
        }
    }
}

/// Computes the convex hull of pixels that are sorted by row and then by column, without the points on its edges.
pub fn convex_hull(points: &[Pixel], hull: &mut Vec<Pixel>) {
    hull.clear();
    for &point in points {
        push_turning_left(hull, 1, point);
    }
    let base = hull.len();
    for &point in points.iter().rev().skip(1) {
        push_turning_left(hull, base, point);
    }
    if points.len() > 1 {
        hull.pop();
    }
}

/// Appends a point to a chain after it has removed those at which the chain would not turn left, but for the first `base`.
fn push_turning_left(chain: &mut Vec<Pixel>, base: usize, point: Pixel) {
    while chain.len() > base {
        let (last, before) = (chain[chain.len() - 1], chain[chain.len() - 2]);
        if cross(difference(last, before), difference(point, before)) > 0 {
            break;
        }
        chain.pop();
    }
    chain.push(point);
}

fn to_point(pixel: Pixel) -> [f64; 2] {
    pixel.map(|value| value as f64)
}

fn difference(a: Pixel, b: Pixel) -> Pixel {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: Pixel, b: Pixel) -> i64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: Pixel, b: Pixel) -> i64 {
    a[0] * b[1] - a[1] * b[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn around(points: &[Pixel]) -> Rectangle {
        let mut hull = Vec::new();
        convex_hull(points, &mut hull);
        Rectangle::around(&hull).unwrap()
    }

    #[test]
    fn hull_leaves_out_points_on_edges_and_inside() {
        let points: Vec<Pixel> = (0..3).flat_map(|y| (0..4).map(move |x| [x, y])).collect();
        let mut hull = Vec::new();
        convex_hull(&points, &mut hull);
        assert_eq!(hull, [[0, 0], [3, 0], [3, 2], [0, 2]]);
    }

    #[test]
    fn points_and_lines_have_no_area() {
        assert_eq!(Rectangle::around(&[]), None);
        assert_eq!(around(&[[3, 4]]).half, [0.0, 0.0]);
        let line = around(&[[0, 0], [1, 1], [2, 2], [3, 3]]);
        assert!((line.half[0] - 4.5_f64.sqrt()).abs() < 1e-12 && line.half[1] == 0.0, "{line:?}");
        assert_eq!(around(&[[0, 1], [5, 1]]).corners(), [[0.0, 1.0], [5.0, 1.0], [5.0, 1.0], [0.0, 1.0]]);
    }

    #[test]
    fn tilted_rectangle_is_found_exactly() {
        // Sides (8, 4) and (-2, 4).
        let found = around(&[[10, 10], [18, 14], [8, 14], [16, 18]]);
        assert!((found.area() - 40.0).abs() < 1e-9, "{found:?}");
        for (corner, expected) in
            found.corners().into_iter().zip([[10.0, 10.0], [18.0, 14.0], [16.0, 18.0], [8.0, 14.0]])
        {
            assert!(
                (corner[0] - expected[0]).abs() < 1e-9 && (corner[1] - expected[1]).abs() < 1e-9,
                "{corner:?}"
            );
        }
    }

    #[test]
    fn calipers_equal_the_search_of_all_edges() {
        let mut state = 7_u64;
        let mut random = |limit: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            ((state >> 33) % limit) as i64
        };
        for _ in 0..500 {
            let mut points: Vec<Pixel> = (0..3 + random(40)).map(|_| [random(50), random(30)]).collect();
            points.sort_by_key(|point| (point[1], point[0]));
            let mut hull = Vec::new();
            convex_hull(&points, &mut hull);
            let found = Rectangle::around(&hull).unwrap();
            let least = (0..hull.len()).map(|edge| area_on_edge(&hull, edge)).fold(f64::INFINITY, f64::min);
            if hull.len() > 1 {
                assert!((found.area() - least).abs() < 1e-9 * (1.0 + least), "{points:?}");
            }
        }
    }

    fn area_on_edge(hull: &[Pixel], edge: usize) -> f64 {
        let along = difference(hull[(edge + 1) % hull.len()], hull[edge]);
        let range = |of: &dyn Fn(Pixel) -> i64| {
            let values = hull.iter().map(|&point| of(point));
            values.clone().max().unwrap() - values.min().unwrap()
        };
        let sides = range(&|point| dot(along, point)) * range(&|point| cross(along, point));
        sides as f64 / dot(along, along) as f64
    }

    #[test]
    fn growth_moves_each_side() {
        let grown = around(&[[2, 2], [12, 2], [2, 6], [12, 6]]).grown(1.5);
        assert_eq!(grown.corners(), [[0.5, 0.5], [13.5, 0.5], [13.5, 7.5], [0.5, 7.5]]);
        assert_eq!((grown.area(), grown.perimeter(), grown.short_side()), (91.0, 40.0, 7.0));
    }
}
