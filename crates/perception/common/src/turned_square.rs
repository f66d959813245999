//! Where a part of the body lies: a square, turned as the body is.
//!
//! MediaPipe's rectangles around palms, hands and persons (Zhang et al., "MediaPipe Hands", 2020), in pixels.

use opendr_vision::Similarity;

/// A square in a picture whose upper side points along `angle`, in radians, clockwise.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TurnedSquare {
    /// Centre, x and y in pixels.
    pub centre: [f32; 2],
    /// Length of a side in pixels.
    pub side: f32,
    /// Angle of the upper side in radians, clockwise.
    pub angle: f32,
}

impl TurnedSquare {
    /// Returns the square around the points, as small as a rectangle turned by `angle` allows; its longer side counts. `None` without
    /// points, or where one is not finite.
    pub fn around(points: impl Iterator<Item = [f32; 2]>, angle: f32) -> Option<Self> {
        let (sine, cosine) = angle.sin_cos();
        let mut edges: Option<[f32; 4]> = None;
        for [x, y] in points {
            let (along, across) = (x * cosine + y * sine, y * cosine - x * sine);
            if !(along + across).is_finite() {
                return None;
            }
            let [x0, y0, x1, y1] = edges.unwrap_or([along, across, along, across]);
            edges = Some([x0.min(along), y0.min(across), x1.max(along), y1.max(across)]);
        }
        let [x0, y0, x1, y1] = edges?;
        let (along, across) = ((x0 + x1) / 2.0, (y0 + y1) / 2.0);
        let centre = [along * cosine - across * sine, along * sine + across * cosine];
        Some(Self { centre, side: (x1 - x0).max(y1 - y0), angle })
    }

    /// Returns the square moved by `down` times its side towards its lower side, then `scale` times as large.
    pub fn moved(self, down: f32, scale: f32) -> Self {
        let (sine, cosine) = self.angle.sin_cos();
        let [x, y] = self.centre;
        let by = down * self.side;
        Self { centre: [x - by * sine, y + by * cosine], side: self.side * scale, ..self }
    }

    /// Returns whether it can show something of a picture: all is finite, it is at least a pixel, at most eight times as large
    /// as the picture, and touches it.
    pub fn is_in(&self, size: [usize; 2]) -> bool {
        let [width, height] = size.map(|side| side as f32);
        let reach = self.side * std::f32::consts::FRAC_1_SQRT_2;
        let touches = |at: f32, end: f32| at > -reach && at < end + reach;
        self.angle.is_finite()
            && self.side >= 1.0
            && self.side <= 8.0 * width.max(height)
            && touches(self.centre[0], width)
            && touches(self.centre[1], height)
    }

    /// Returns the square as a crop of `side` pixels.
    pub fn crop(&self, side: usize) -> Similarity {
        Similarity::rotated_square(self.centre, self.side, self.angle, side)
    }

    /// Returns `[left, top, right, bottom]` as if it were upright: how squares are compared.
    pub fn upright(&self) -> [f32; 4] {
        let ([x, y], half) = (self.centre, self.side / 2.0);
        [x - half, y - half, x + half, y + half]
    }
}

/// Returns the angle of a square that shows the way from `low` to `high` as upwards.
pub fn angle_upwards(low: [f32; 2], high: [f32; 2]) -> f32 {
    (high[0] - low[0]).atan2(low[1] - high[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn upwards_is_upwards() {
        for (low, high) in [([10.0, 20.0], [10.0, 5.0]), ([4.0, 4.0], [9.0, 4.0]), ([4.0, 4.0], [1.0, 9.0])] {
            let square = TurnedSquare { centre: low, side: 20.0, angle: angle_upwards(low, high) };
            let [x, y] = square.crop(20).crop_from_image(high);
            assert!((x - 10.0).abs() < 1e-3 && y < 9.0, "{x} {y}");
        }
    }

    #[test]
    fn points_lie_within() {
        let points = [[10.0, 10.0], [50.0, 30.0], [20.0, 44.0]];
        let square = TurnedSquare::around(points.into_iter(), 0.7).unwrap();
        for point in points {
            let crop = square.crop(100).crop_from_image(point);
            assert!(crop.iter().all(|at| (-0.01..=100.01).contains(at)), "{crop:?}");
        }
        let moved = square.moved(-0.1, 2.0);
        assert_eq!(moved.side, 2.0 * square.side);
        let [x, y] = square.crop(100).crop_from_image(moved.centre);
        assert!((x - 50.0).abs() < 0.01 && (y - 40.0).abs() < 0.01);
        assert!(TurnedSquare::around(std::iter::empty(), 0.0).is_none());
        assert!(TurnedSquare::around([[f32::NAN, 0.0]].into_iter(), 0.0).is_none());
    }

    #[test]
    fn only_what_shows_something_is_in() {
        let square = TurnedSquare { centre: [50.0, 50.0], side: 20.0, angle: 1.0 };
        assert!(square.is_in([100, 100]));
        assert!(!square.is_in([20, 20]));
        assert!(!TurnedSquare { side: f32::NAN, ..square }.is_in([100, 100]));
        assert!(!TurnedSquare { side: 0.5, ..square }.is_in([100, 100]));
        assert!(!TurnedSquare { side: 900.0, ..square }.is_in([100, 100]));
        assert!(!TurnedSquare { angle: f32::INFINITY, ..square }.is_in([100, 100]));
    }
}
