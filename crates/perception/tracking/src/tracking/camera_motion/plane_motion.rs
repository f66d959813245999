//! A similarity motion of the image plane.

/// Scale, rotation and shift that map points of one frame to the next, in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SimilarityMotion {
    /// Scale times cosine and sine of the angle, from x to y.
    turn: [f64; 2],
    shift: [f64; 2],
}

impl SimilarityMotion {
    /// No motion.
    pub const NONE: Self = Self { turn: [1.0, 0.0], shift: [0.0, 0.0] };

    /// Creates a motion from scale times cosine and sine of the angle, and the position of the mapped (0, 0).
    pub const fn new(turn: [f64; 2], shift: [f64; 2]) -> Self {
        Self { turn, shift }
    }

    /// Maps a point.
    pub fn map(&self, point: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.map_direction(point);
        [x + self.shift[0], y + self.shift[1]]
    }

    /// Maps a direction, such as a velocity.
    pub fn map_direction(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [a, b] = self.turn;
        [a * x - b * y, b * x + a * y]
    }

    /// Returns the scale.
    pub fn scale(&self) -> f64 {
        self.turn[0].hypot(self.turn[1])
    }

    /// Maps the centre of an upright box `[x0, y0, x1, y1]` and scales its sides; it stays upright.
    pub fn map_box(&self, [x0, y0, x1, y1]: [f64; 4]) -> [f64; 4] {
        let [x, y] = self.map([(x0 + x1) / 2.0, (y0 + y1) / 2.0]);
        let [across, down] = [x1 - x0, y1 - y0].map(|side| side * self.scale() / 2.0);
        [x - across, y - down, x + across, y + down]
    }
}
