//! Grasps from the network's maps.

use opendr_engine::{Error, Result};

/// Smoothed maps of grasp quality, angle and width.
#[derive(Debug, Default)]
pub struct Maps {
    quality: Vec<f32>,
    angle: Vec<f32>,
    width: Vec<f32>,
    rows: Vec<f32>,
}

/// A local maximum of the quality.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Column on the map.
    pub x: usize,
    /// Row on the map.
    pub y: usize,
    /// Quality, about 0..=1.
    pub quality: f32,
    /// Angle to the x axis, counter-clockwise in the image, in radians, -pi/2..=pi/2.
    pub angle: f32,
    /// Width, about 0..=1.
    pub width: f32,
}

/// Standard deviations of the Gaussian filters of quality, angle and width, in pixels; cut at four of them.
const SIGMAS: [f32; 3] = [2.0, 2.0, 1.0];
const CUT: f32 = 4.0;

impl Maps {
    /// Reads the maps of quality, cosine and sine of twice the angle, and width, `side` x `side` each.
    ///
    /// # Errors
    /// `Format` when a map has another size.
    pub fn read(&mut self, maps: [&[f32]; 4], side: usize) -> Result<()> {
        if let Some(wrong) = maps.iter().find(|map| map.len() != side * side) {
            let count = wrong.len();
            return Err(Error::format(format!(
                "the network returns a map of {count} values instead of {side}x{side}"
            )));
        }
        let [quality, cosine, sine, width] = maps;
        let Self { quality: smooth_quality, angle, width: smooth_width, rows } = self;
        smooth_quality.clear();
        smooth_quality.extend_from_slice(quality);
        angle.clear();
        angle.extend(sine.iter().zip(cosine).map(|(sine, cosine)| 0.5 * sine.atan2(*cosine)));
        smooth_width.clear();
        smooth_width.extend_from_slice(width);
        for (map, sigma) in [smooth_quality, angle, smooth_width].into_iter().zip(SIGMAS) {
            smooth(map, side, sigma, rows);
        }
        Ok(())
    }

    /// Writes at most `most` peaks of the quality, sorted by quality: each at least `threshold`, the maximum within `distance`
    /// pixels, and farther than that from the previous ones.
    pub fn peaks(&self, side: usize, threshold: f32, distance: usize, most: usize, peaks: &mut Vec<Peak>) {
        peaks.clear();
        let candidates = (0..side * side).filter(|&at| {
            let (x, y) = (at % side, at / side);
            let here = self.quality[at];
            // Pixels may equal their neighbours: of the many on a plateau, the first survives below.
            here >= threshold && self.neighbours(side, x, y).all(|there| there <= here)
        });
        peaks.extend(candidates.map(|at| Peak {
            x: at % side,
            y: at / side,
            quality: self.quality[at],
            angle: self.angle[at],
            width: self.width[at],
        }));
        peaks.sort_by(|one, other| other.quality.total_cmp(&one.quality));
        let mut kept = 0;
        for at in 0..peaks.len() {
            let peak = peaks[at];
            let near = |other: &Peak| other.x.abs_diff(peak.x).max(other.y.abs_diff(peak.y)) <= distance;
            if kept < most && !peaks[..kept].iter().any(near) {
                peaks[kept] = peak;
                kept += 1;
            }
        }
        peaks.truncate(kept);
    }

    fn neighbours(&self, side: usize, x: usize, y: usize) -> impl Iterator<Item = f32> {
        let around = move |at: usize| at.saturating_sub(1)..=(at + 1).min(side - 1);
        around(y).flat_map(move |y| around(x).map(move |x| self.quality[y * side + x]))
    }
}

/// Smooths a map with a Gaussian filter; the border is repeated. `rows` is a buffer.
fn smooth(map: &mut [f32], side: usize, sigma: f32, rows: &mut Vec<f32>) {
    let reach = (CUT * sigma).round() as isize;
    let weight = |offset: isize| (-0.5 * (offset as f32 / sigma).powi(2)).exp();
    let sum: f32 = (-reach..=reach).map(weight).sum();
    let inside = |at: usize, offset: isize| at.saturating_add_signed(offset).min(side - 1);
    rows.clear();
    rows.resize(map.len(), 0.0);
    for offset in -reach..=reach {
        let share = weight(offset) / sum;
        for (to, from) in rows.chunks_exact_mut(side).zip(map.chunks_exact(side)) {
            for (x, to) in to.iter_mut().enumerate() {
                *to += share * from[inside(x, offset)];
            }
        }
    }
    map.fill(0.0);
    for offset in -reach..=reach {
        let share = weight(offset) / sum;
        for (y, to) in map.chunks_exact_mut(side).enumerate() {
            let from = inside(y, offset) * side;
            for (to, from) in to.iter_mut().zip(&rows[from..from + side]) {
                *to += share * from;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 32;

    fn maps(bumps: &[(usize, usize, f32)]) -> Maps {
        let mut quality = vec![0.0; SIDE * SIDE];
        for &(x, y, height) in bumps {
            quality[y * SIDE + x] = height;
        }
        let one = vec![1.0; SIDE * SIDE];
        let zero = vec![0.0; SIDE * SIDE];
        let mut maps = Maps::default();
        maps.read([&quality, &zero, &one, &one], SIDE).unwrap();
        maps
    }

    #[test]
    fn peaks_keep_their_distance() {
        let maps = maps(&[(5, 6, 1.0), (9, 6, 0.9), (25, 20, 0.5)]);
        let mut peaks = Vec::new();
        maps.peaks(SIDE, 0.001, 6, 10, &mut peaks);
        let places: Vec<_> = peaks.iter().map(|peak| (peak.x, peak.y)).collect();
        assert_eq!(places, [(6, 6), (25, 20)]);
        assert!((peaks[0].angle - std::f32::consts::FRAC_PI_4).abs() < 1e-4, "{peaks:?}");
        assert!((peaks[0].width - 1.0).abs() < 1e-4);
        maps.peaks(SIDE, 0.001, 6, 1, &mut peaks);
        assert_eq!(peaks.len(), 1);
        maps.peaks(SIDE, 0.5, 6, 10, &mut peaks);
        assert!(peaks.is_empty());
    }

    #[test]
    fn maps_of_another_size_are_refused() {
        let short = vec![0.0; 5];
        assert!(Maps::default().read([&short; 4], SIDE).is_err());
    }
}
