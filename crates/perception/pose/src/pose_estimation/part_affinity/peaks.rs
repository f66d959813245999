//! Peaks of heatmaps with subcell precision.

use super::layout::JOINTS;
use super::maps::{PartMaps, Plane};
use super::parameters::PartAffinity;

/// A peak of a heatmap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Peak {
    /// Position in cells.
    pub(super) place: [f32; 2],
    /// Height, 0..=1.
    pub(super) score: f32,
    pub(super) joint: usize,
}

/// Maximum number of peaks per joint, whose pairs all get scores.
const MOST: usize = 64;

/// Height in the nearest cell relative to the peak: exp(-0.33) for a Gaussian with a standard deviation of most of a stride
/// and its peak in the middle of four cells.
const LEFT_IN_CELL: f32 = 0.7;

/// Number of cells on either side of a peak that its upsampling reads.
const REACH: usize = 2;
const TAPS: usize = 2 * REACH + 1;
const MOST_STEPS: usize = 2 * PartAffinity::MAX_UPSAMPLE_RATIO + 1;

/// Fills `peaks`, joint by joint, highest first, and returns the end of each joint's peaks.
pub(super) fn find(how: &PartAffinity, maps: &PartMaps<'_>, peaks: &mut Vec<Peak>) -> [usize; JOINTS] {
    peaks.clear();
    let upsampling = Upsampling::new(how.upsample_ratio);
    let radius = how.radius / maps.grid().stride;
    std::array::from_fn(|joint| {
        let start = peaks.len();
        let plane = maps.heat(joint);
        plane.each_maximum(LEFT_IN_CELL * how.peak_threshold, |x, y| {
            let (place, height) = upsampling.peak(&plane, x, y);
            if height >= how.peak_threshold {
                peaks.push(Peak { place, score: height.min(1.0), joint });
            }
        });
        peaks[start..].sort_unstable_by(|a, b| {
            b.score
                .total_cmp(&a.score)
                .then(a.place[1].total_cmp(&b.place[1]))
                .then(a.place[0].total_cmp(&b.place[0]))
        });
        let end = start + thin_out(&mut peaks[start..], radius);
        peaks.truncate(end);
        end
    })
}

/// Moves the peaks without a higher one within the radius to the front, and returns their number.
fn thin_out(peaks: &mut [Peak], radius: f32) -> usize {
    let mut kept = 0;
    for at in 0..peaks.len() {
        let Peak { place: [x, y], .. } = peaks[at];
        let near =
            |other: &Peak| (other.place[0] - x).powi(2) + (other.place[1] - y).powi(2) < radius * radius;
        if kept < MOST && !peaks[..kept].iter().any(near) {
            peaks[kept] = peaks[at];
            kept += 1;
        }
    }
    kept
}

impl Plane<'_> {
    /// Calls `found` for the cells that reach the threshold and are higher than the eight around; of equal ones for the
    /// first.
    fn each_maximum(&self, threshold: f32, mut found: impl FnMut(usize, usize)) {
        for y in 0..self.rows {
            let row = &self.values[y * self.columns..(y + 1) * self.columns];
            for (x, value) in row.iter().copied().enumerate() {
                // NaN is below any threshold.
                if value >= threshold && value.is_finite() && self.is_maximum(x, y, value) {
                    found(x, y);
                }
            }
        }
    }

    fn is_maximum(&self, x: usize, y: usize, value: f32) -> bool {
        let (left, right) = (x.saturating_sub(1), (x + 1).min(self.columns - 1));
        let row = |y: usize| &self.values[y * self.columns + left..=y * self.columns + right];
        let before = y.checked_sub(1).is_none_or(|above| row(above).iter().all(|other| *other < value))
            && (x == 0 || self.values[y * self.columns + x - 1] < value);
        let after = || {
            (x == right || self.values[y * self.columns + x + 1] <= value)
                && (y + 1 == self.rows || row(y + 1).iter().all(|other| *other <= value))
        };
        before && after()
    }
}

/// Minimum value of maps around a peak, for the logarithm: painted ones end at a hundredth.
const FLOOR: f32 = 0.01;

/// Cubic convolution (Keys, 1981, a = -1/2) from one cell before to one cell after a cell, in steps.
///
/// It is exact for parabolas, and the logarithm of a Gaussian is one, so logarithms are upsampled. The map itself would
/// shift a peak between two cells by an eighth of a cell towards one of them.
struct Upsampling {
    ratio: usize,
    /// Weights of the five cells around, for each step.
    weights: [[f32; TAPS]; MOST_STEPS],
}

impl Upsampling {
    fn new(ratio: usize) -> Self {
        let ratio = ratio.clamp(1, PartAffinity::MAX_UPSAMPLE_RATIO);
        let mut weights = [[0.0; TAPS]; MOST_STEPS];
        for (step, weights) in weights.iter_mut().enumerate().take(2 * ratio + 1) {
            let place = step as f32 / ratio as f32 - 1.0;
            *weights = std::array::from_fn(|tap| cubic(place - (tap as f32 - REACH as f32)));
        }
        Self { ratio, weights }
    }

    /// Returns the position of the maximum, in cells, within a cell of `[x, y]`, and its height.
    fn peak(&self, plane: &Plane<'_>, x: usize, y: usize) -> ([f32; 2], f32) {
        let steps = 2 * self.ratio + 1;
        let tap = |centre: usize, tap: usize| centre as isize + tap as isize - REACH as isize;
        let mut along_x = [[0.0; MOST_STEPS]; TAPS];
        for (row, along_x) in along_x.iter_mut().enumerate() {
            let cells: [f32; TAPS] =
                std::array::from_fn(|column| plane.at(tap(x, column), tap(y, row)).max(FLOOR).ln());
            for (value, weights) in along_x.iter_mut().zip(&self.weights).take(steps) {
                *value = cells.iter().zip(weights).map(|(cell, weight)| cell * weight).sum();
            }
        }
        let value = |column: usize, row: usize| -> f32 {
            along_x.iter().zip(self.weights[row]).map(|(along_x, weight)| along_x[column] * weight).sum()
        };
        let mut best = ([self.ratio; 2], f32::NEG_INFINITY);
        for row in 0..steps {
            for column in 0..steps {
                let value = value(column, row);
                if value > best.1 {
                    best = ([column, row], value);
                }
            }
        }
        let ([column, row], height) = best;
        let inside = |at: usize| at > 0 && at + 1 < steps;
        let (dx, more_x) = match inside(column) {
            true => parabola_maximum(value(column - 1, row), height, value(column + 1, row)),
            false => (0.0, 0.0),
        };
        let (dy, more_y) = match inside(row) {
            true => parabola_maximum(value(column, row - 1), height, value(column, row + 1)),
            false => (0.0, 0.0),
        };
        let place = |cell: usize, step: usize, more: f32| {
            cell as f32 + (step as f32 + more) / self.ratio as f32 - 1.0
        };
        ([place(x, column, dx), place(y, row, dy)], (height + more_x + more_y).exp())
    }
}

/// Returns the maximum of the parabola through three values, of which the middle one is the highest: its position in steps
/// from the middle, and its height above the middle.
fn parabola_maximum(before: f32, middle: f32, after: f32) -> (f32, f32) {
    let curvature = before - 2.0 * middle + after;
    if curvature >= 0.0 || !curvature.is_finite() {
        return (0.0, 0.0);
    }
    let place = (0.5 * (before - after) / curvature).clamp(-0.5, 0.5);
    (place, -0.25 * (before - after) * place)
}

fn cubic(distance: f32) -> f32 {
    let x = distance.abs();
    if x < 1.0 {
        (1.5 * x - 2.5) * x * x + 1.0
    } else if x < 2.0 {
        ((-0.5 * x + 2.5) * x - 4.0) * x + 2.0
    } else {
        0.0
    }
}
