//! What may lie where the camera has not looked.

use super::{HALF_TRACK, HALF_WIDTH, SIDE};
use crate::sine_cosine::sine_cosine;

pub const CELL: f32 = 0.2;
pub const AHEAD: usize = 50;
pub const BEHIND: usize = 5;
pub const ASIDE: usize = 25;
pub const COLUMNS: usize = BEHIND + 1 + AHEAD;
pub const ROWS: usize = 2 * ASIDE + 1;
pub const PATCH: i32 = 2;
pub const FEATURES: usize = 6 + 2 * 25;
pub const HIDDEN: usize = 24;

#[derive(Debug, Clone, Copy)]
pub struct Frame {
    pub x: f32,
    pub y: f32,
    pub sine: f32,
    pub cosine: f32,
    pub ahead: [f32; SIDE],
}

#[derive(Debug, Clone)]
pub struct Raster {
    /// Metres behind the nearest surface, least of all frames; NaN where never seen.
    pub shadow: Vec<f32>,
    pub marked: Vec<f32>,
    pub clearance: Vec<f32>,
    pub offset: f32,
}

impl Raster {
    pub fn new() -> Self {
        let n = COLUMNS * ROWS;
        Self { shadow: vec![0.0; n], marked: vec![0.0; n], clearance: vec![0.0; n], offset: 0.0 }
    }

    /// Around the drone at x, y in the corridor.
    pub fn draw(&mut self, frames: &[Frame], points: &[[f32; 2]], x: f32, y: f32) {
        self.offset = y;
        for column in 0..COLUMNS {
            for row in 0..ROWS {
                let (wx, wy) = (x + (column as f32 - BEHIND as f32) * CELL, y + (row as f32 - ASIDE as f32) * CELL);
                let mut least = f32::INFINITY;
                for frame in frames {
                    let (dx, dy) = (wx - frame.x, wy - frame.y);
                    let a = frame.cosine * dx + frame.sine * dy;
                    let l = frame.cosine * dy - frame.sine * dx;
                    if a > 0.05 && l.abs() < a * HALF_WIDTH {
                        let at = ((1.0 - l / (a * HALF_WIDTH)) * 0.5 * SIDE as f32) as usize;
                        least = least.min(a - frame.ahead[at.min(SIDE - 1)]);
                    }
                }
                self.shadow[column * ROWS + row] = if least.is_finite() || least < 0.0 { least.max(-1.0) } else { f32::NAN };
            }
        }
        self.marked.fill(0.0);
        self.clearance.fill(2.0);
        for [ahead, left] in points {
            let (c, r) = ((ahead / CELL + BEHIND as f32 + 0.5).floor(), (left / CELL + ASIDE as f32 + 0.5).floor());
            if c >= 0.0 && r >= 0.0 && (c as usize) < COLUMNS && (r as usize) < ROWS {
                let (c, r) = (c as usize, r as usize);
                self.marked[c * ROWS + r] = 1.0;
                self.clearance[c * ROWS + r] = 0.0;
            }
        }
        // Chamfer distances.
        let (one, two) = (CELL, CELL * std::f32::consts::SQRT_2);
        for c in 0..COLUMNS {
            for r in 0..ROWS {
                let mut d = self.clearance[c * ROWS + r];
                if r > 0 { d = d.min(self.clearance[c * ROWS + r - 1] + one); }
                if c > 0 {
                    let p = (c - 1) * ROWS;
                    d = d.min(self.clearance[p + r] + one);
                    if r > 0 { d = d.min(self.clearance[p + r - 1] + two); }
                    if r + 1 < ROWS { d = d.min(self.clearance[p + r + 1] + two); }
                }
                self.clearance[c * ROWS + r] = d;
            }
        }
        for c in (0..COLUMNS).rev() {
            for r in (0..ROWS).rev() {
                let mut d = self.clearance[c * ROWS + r];
                if r + 1 < ROWS { d = d.min(self.clearance[c * ROWS + r + 1] + one); }
                if c + 1 < COLUMNS {
                    let p = (c + 1) * ROWS;
                    d = d.min(self.clearance[p + r] + one);
                    if r > 0 { d = d.min(self.clearance[p + r - 1] + two); }
                    if r + 1 < ROWS { d = d.min(self.clearance[p + r + 1] + two); }
                }
                self.clearance[c * ROWS + r] = d;
            }
        }
    }

    /// Whether nothing is to be asked: it was seen to be free, and so was all around.
    pub fn is_clear(&self, cell: usize) -> bool {
        self.clearance[cell] > 0.85 && self.shadow[cell] < -0.85
    }

    pub fn features(&self, column: usize, row: usize, to: &mut [f32; FEATURES]) {
        let cell = column * ROWS + row;
        let side = self.offset + (row as f32 - ASIDE as f32) * CELL;
        let s = self.shadow[cell];
        to[0] = if s.is_nan() { 0.0 } else { s.clamp(-1.0, 3.0) * 0.5 };
        to[1] = f32::from(s.is_nan());
        to[2] = self.clearance[cell].min(2.0);
        to[3] = f32::from(s < -0.1);
        to[4] = side.abs() / HALF_TRACK;
        to[5] = (column as f32 - BEHIND as f32) / AHEAD as f32;
        let mut at = 6;
        for dc in -PATCH..=PATCH {
            for dr in -PATCH..=PATCH {
                let c = (column as i32 + 2 * dc).clamp(0, COLUMNS as i32 - 1) as usize;
                let r = (row as i32 + 2 * dr).clamp(0, ROWS as i32 - 1) as usize;
                let s = self.shadow[c * ROWS + r];
                to[at] = (1.0 - self.clearance[c * ROWS + r] * 2.0).max(0.0);
                to[at + 25] = if s.is_nan() { 0.5 } else { (s + 0.1).clamp(-0.5, 1.0) };
                at += 1;
            }
        }
    }
}

/// An MLP of two logits: P(closer than 0.3 m), P(closer than 0.55 m).
#[derive(Debug, Clone)]
pub struct Guess {
    pub w: Vec<f32>,
}

pub const W1: usize = FEATURES * HIDDEN;
pub const B1: usize = W1 + HIDDEN;
pub const W2: usize = B1 + HIDDEN * 2;
pub const TOTAL: usize = W2 + 2;

impl Guess {
    pub fn forward(&self, x: &[f32; FEATURES], hidden: &mut [f32; HIDDEN]) -> [f32; 2] {
        hidden.copy_from_slice(&self.w[W1..B1]);
        for (x, row) in x.iter().zip(self.w[..W1].chunks_exact(HIDDEN)) {
            for (h, w) in hidden.iter_mut().zip(row) {
                *h += x * w;
            }
        }
        let mut out = [self.w[W2], self.w[W2 + 1]];
        for (h, w) in hidden.iter_mut().zip(self.w[B1..W2].chunks_exact(2)) {
            *h = h.max(0.0);
            out[0] += *h * w[0];
            out[1] += *h * w[1];
        }
        out.map(|o| 1.0 / (1.0 + (-o).exp()))
    }
}

pub fn frame(x: f32, y: f32, yaw: f64, ahead: [f32; SIDE]) -> Frame {
    let (sine, cosine) = sine_cosine(yaw);
    Frame { x, y, sine: sine as f32, cosine: cosine as f32, ahead }
}
