//! Rotated squares around parts of the body.
//!
//! They are MediaPipe's rectangles around palms, hands and persons (Zhang et al., "MediaPipe Hands", 2020), in pixels.

use opendr_vision::Similarity;

/// A rotated square in an image; its upper side points along `angle`, in radians, clockwise.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RotatedSquare {
    /// Centre, x and y in pixels.
    pub centre: [f32; 2],
    /// Length of a side in pixels.
    pub side: f32,
    /// Angle of the upper side in radians, clockwise.
    pub angle: f32,
}

impl RotatedSquare {
    /// Returns the square around the points. Its side is the longer side of the smallest rectangle rotated by `angle`.
    /// `None` without points, or where one is not finite.
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

    /// Returns the square moved by `down` times its side towards its lower side, then scaled by `scale`.
    pub fn moved(self, down: f32, scale: f32) -> Self {
        let (sine, cosine) = self.angle.sin_cos();
        let [x, y] = self.centre;
        let by = down * self.side;
        Self { centre: [x - by * sine, y + by * cosine], side: self.side * scale, ..self }
    }

    /// Returns whether a crop by the square is useful: its values are finite, its side is at least a pixel and at most
    /// eight times the image's longer side, and it touches the image.
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

    /// Returns the crop of the square, resized to `side` pixels.
    pub fn crop(&self, side: usize) -> Similarity {
        Similarity::rotated_square(self.centre, self.side, self.angle, side)
    }

    /// Returns `[left, top, right, bottom]` of the square without its rotation, by which squares are compared.
    pub fn upright(&self) -> [f32; 4] {
        let ([x, y], half) = (self.centre, self.side / 2.0);
        [x - half, y - half, x + half, y + half]
    }
}

/// Returns the angle of a square in which the direction from `low` to `high` points upwards.
pub fn angle_upwards(low: [f32; 2], high: [f32; 2]) -> f32 {
    (high[0] - low[0]).atan2(low[1] - high[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angle_upwards_points_up() {
        for (low, high) in [([10.0, 20.0], [10.0, 5.0]), ([4.0, 4.0], [9.0, 4.0]), ([4.0, 4.0], [1.0, 9.0])] {
            let square = RotatedSquare { centre: low, side: 20.0, angle: angle_upwards(low, high) };
            let [x, y] = square.crop(20).crop_from_image(high);
            assert!((x - 10.0).abs() < 1e-3 && y < 9.0, "{x} {y}");
        }
    }

    #[test]
    fn points_lie_within() {
        let points = [[10.0, 10.0], [50.0, 30.0], [20.0, 44.0]];
        let square = RotatedSquare::around(points.into_iter(), 0.7).unwrap();
        for point in points {
            let crop = square.crop(100).crop_from_image(point);
            assert!(crop.iter().all(|at| (-0.01..=100.01).contains(at)), "{crop:?}");
        }
        let moved = square.moved(-0.1, 2.0);
        assert_eq!(moved.side, 2.0 * square.side);
        let [x, y] = square.crop(100).crop_from_image(moved.centre);
        assert!((x - 50.0).abs() < 0.01 && (y - 40.0).abs() < 0.01);
        assert!(RotatedSquare::around(std::iter::empty(), 0.0).is_none());
        assert!(RotatedSquare::around([[f32::NAN, 0.0]].into_iter(), 0.0).is_none());
    }

    #[test]
    fn only_useful_squares_are_in() {
        let square = RotatedSquare { centre: [50.0, 50.0], side: 20.0, angle: 1.0 };
        assert!(square.is_in([100, 100]));
        assert!(!square.is_in([20, 20]));
        assert!(!RotatedSquare { side: f32::NAN, ..square }.is_in([100, 100]));
        assert!(!RotatedSquare { side: 0.5, ..square }.is_in([100, 100]));
        assert!(!RotatedSquare { side: 900.0, ..square }.is_in([100, 100]));
        assert!(!RotatedSquare { angle: f32::INFINITY, ..square }.is_in([100, 100]));
    }
}
