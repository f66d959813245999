//! A motion of everything in a picture.

/// A scale, a turn and a shift that bring points of one frame to where they are in the next, pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneMotion {
    /// Scale times cosine and sine of the angle, from x to y.
    turn: [f64; 2],
    shift: [f64; 2],
}

impl PlaneMotion {
    /// Nothing moves.
    pub const NONE: Self = Self { turn: [1.0, 0.0], shift: [0.0, 0.0] };

    /// Scale times cosine and sine of the angle, and where (0, 0) goes.
    pub const fn new(turn: [f64; 2], shift: [f64; 2]) -> Self {
        Self { turn, shift }
    }

    /// Where a point goes.
    pub fn map(&self, point: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.turn(point);
        [x + self.shift[0], y + self.shift[1]]
    }

    /// What becomes of a direction: a velocity, say.
    pub fn turn(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [a, b] = self.turn;
        [a * x - b * y, b * x + a * y]
    }

    /// How much larger everything becomes.
    pub fn scale(&self) -> f64 {
        self.turn[0].hypot(self.turn[1])
    }

    /// Where an upright box `[x0, y0, x1, y1]` goes; it stays upright.
    pub fn map_box(&self, [x0, y0, x1, y1]: [f64; 4]) -> [f64; 4] {
        let [x, y] = self.map([(x0 + x1) / 2.0, (y0 + y1) / 2.0]);
        let [across, down] = [x1 - x0, y1 - y0].map(|side| side * self.scale() / 2.0);
        [x - across, y - down, x + across, y + down]
    }
}
