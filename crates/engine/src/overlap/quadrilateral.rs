//! Overlap of convex quadrilaterals, such as regions of text.

use super::polygon::Polygon;

/// A convex quadrilateral on a plane, by its corners in either direction of rotation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quadrilateral {
    corners: [[f64; 2]; 4],
    area: f64,
}

impl Quadrilateral {
    /// Creates a quadrilateral from its corners; `None` unless they are finite, convex and enclose an area.
    pub fn new(corners: [[f64; 2]; 4]) -> Option<Self> {
        let turns: [f64; 4] = std::array::from_fn(|at| {
            let [a, b, c] = [at, at + 1, at + 2].map(|corner| corners[corner % 4]);
            (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
        });
        let area = Polygon::new(corners).area();
        let is_convex = turns.iter().all(|turn| *turn >= 0.0) || turns.iter().all(|turn| *turn <= 0.0);
        let is_sound = corners.iter().flatten().all(|number| number.is_finite()) && is_convex;
        let clockwise = turns.iter().sum::<f64>() < 0.0;
        let [a, b, c, d] = corners;
        (is_sound && area > 0.0 && area.is_finite())
            .then_some(Self { corners: if clockwise { [d, c, b, a] } else { corners }, area })
    }

    /// Returns the area.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Returns the area of the intersection with `other`, exact except for rounding (Sutherland and Hodgman, 1974).
    pub fn intersection_area(&self, other: &Self) -> f64 {
        let nexts = other.corners.iter().cycle().skip(1);
        let sides = other.corners.iter().zip(nexts);
        sides.fold(Polygon::new(self.corners), |polygon, (begin, end)| polygon.beside(*begin, *end)).area()
    }

    /// Returns the intersection over union.
    pub fn iou(&self, other: &Self) -> f64 {
        let shared = self.intersection_area(other);
        shared / (self.area + other.area - shared)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(corners: [[f64; 2]; 4]) -> Quadrilateral {
        Quadrilateral::new(corners).unwrap()
    }

    #[test]
    fn overlaps_are_those_of_the_plane() {
        let square = of([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
        let reversed = of([[0.0, 2.0], [2.0, 2.0], [2.0, 0.0], [0.0, 0.0]]);
        assert_eq!((square.area(), square.iou(&reversed)), (4.0, 1.0));
        let diamond = of([[1.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 1.0]]);
        assert_eq!(square.intersection_area(&diamond), 2.0);
        assert_eq!(diamond.iou(&square), 0.5);
        let shifted = of([[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]]);
        assert!((square.iou(&shifted) - 1.0 / 7.0).abs() < 1e-12);
        let apart = of([[5.0, 0.0], [6.0, 0.0], [6.0, 1.0], [5.0, 1.0]]);
        assert_eq!(square.iou(&apart), 0.0);
        // A trapezoid of height 2 with sides of 4 and 2 over its own half.
        let trapezoid = of([[0.0, 0.0], [4.0, 0.0], [3.0, 2.0], [1.0, 2.0]]);
        let lower = of([[-1.0, 0.0], [5.0, 0.0], [5.0, 1.0], [-1.0, 1.0]]);
        assert!((trapezoid.intersection_area(&lower) - 3.5).abs() < 1e-12);
    }

    #[test]
    fn corners_without_a_convex_area_are_refused() {
        let line = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0]];
        let crossed = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        let dented = [[0.0, 0.0], [4.0, 0.0], [1.0, 1.0], [0.0, 4.0]];
        let broken = [[0.0, 0.0], [f64::NAN, 0.0], [1.0, 1.0], [0.0, 1.0]];
        for corners in [line, crossed, dented, broken, [[0.0; 2]; 4], [[f64::INFINITY; 2]; 4]] {
            assert_eq!(Quadrilateral::new(corners), None, "{corners:?}");
        }
    }
}
