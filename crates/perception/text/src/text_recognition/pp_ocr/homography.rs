//! The projective map from the unit square to a quadrilateral.

/// A 3x3 matrix, row by row, with 1 as its last entry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Homography([f64; 8]);

impl Homography {
    /// Returns the map that takes (0, 0), (1, 0), (1, 1) and (0, 1) to the corners of a strictly convex quadrilateral. `None` if it is not one
    /// or has corners that are not finite.
    pub fn from_unit_square(corners: &[[f64; 2]; 4]) -> Option<Self> {
        if !is_convex(corners) {
            return None;
        }
        let [[x0, y0], [x1, y1], [x2, y2], [x3, y3]] = *corners;
        let (a, b) = ([x1 - x2, y1 - y2], [x3 - x2, y3 - y2]);
        let bent = [x0 - x1 + x2 - x3, y0 - y1 + y2 - y3];
        let area = cross(a, b);
        let (g, h) = (cross(bent, b) / area, cross(a, bent) / area);
        let matrix = [x1 - x0 + g * x1, x3 - x0 + h * x3, x0, y1 - y0 + g * y1, y3 - y0 + h * y3, y0, g, h];
        matrix.iter().all(|value| value.is_finite()).then_some(Self(matrix))
    }

    /// Returns where a point goes.
    pub fn apply(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let [a, b, c, d, e, f, g, h] = self.0;
        let scale = 1.0 / (g * u + h * v + 1.0);
        [(a * u + b * v + c) * scale, (d * u + e * v + f) * scale]
    }
}

/// Whether a quadrilateral turns to the same side at each of its corners, by more than rounding.
fn is_convex(corners: &[[f64; 2]; 4]) -> bool {
    let side = |index: usize| {
        let (from, to) = (corners[index % 4], corners[(index + 1) % 4]);
        [to[0] - from[0], to[1] - from[1]]
    };
    let length = |[x, y]: [f64; 2]| x.hypot(y);
    let turns = [0, 1, 2, 3].map(|index| {
        let (before, after) = (side(index), side(index + 1));
        cross(before, after) / (length(before) * length(after))
    });
    turns.iter().all(|&turn| turn > 1e-6) || turns.iter().all(|&turn| turn < -1e-6)
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    #[test]
    fn corners_go_to_corners() {
        for corners in [
            [[2.0, 3.0], [12.0, 3.0], [12.0, 8.0], [2.0, 8.0]],
            [[0.0, 0.0], [10.0, 2.0], [8.0, 9.0], [-1.0, 6.0]],
            [[-1.0, 6.0], [8.0, 9.0], [10.0, 2.0], [0.0, 0.0]],
        ] {
            let map = Homography::from_unit_square(&corners).unwrap();
            for (point, corner) in SQUARE.into_iter().zip(corners) {
                let found = map.apply(point);
                assert!(
                    (found[0] - corner[0]).abs() < 1e-12 && (found[1] - corner[1]).abs() < 1e-12,
                    "{found:?}"
                );
            }
        }
    }

    #[test]
    fn diagonals_cross_in_the_image_of_the_centre() {
        // The diagonals (0,0)-(6,6) and (8,0)-(0,4) cross at (8/3, 8/3).
        let map = Homography::from_unit_square(&[[0.0, 0.0], [8.0, 0.0], [6.0, 6.0], [0.0, 4.0]]).unwrap();
        let [x, y] = map.apply([0.5, 0.5]);
        assert!((x - 8.0 / 3.0).abs() < 1e-12 && (y - 8.0 / 3.0).abs() < 1e-12, "{x} {y}");
    }

    #[test]
    fn degenerate_quadrilaterals_have_none() {
        for corners in [
            [[1.0, 1.0]; 4],
            [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]],
            [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]],
            [[0.0, 0.0], [4.0, 0.0], [1.0, 1.0], [0.0, 4.0]],
            [[f64::NAN, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]],
            [[0.0, 0.0], [f64::INFINITY, 0.0], [4.0, 4.0], [0.0, 4.0]],
        ] {
            assert_eq!(Homography::from_unit_square(&corners), None, "{corners:?}");
        }
    }
}
