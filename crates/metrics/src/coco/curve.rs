//! From verdicts in the order of scores to precision over recall.

use super::matching::Verdict;
use super::protocol::{RECALLS, THRESHOLDS, recalls};

/// What became of a detection, and where it stands in the order of all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ranked {
    pub score: f64,
    /// Number of its picture.
    pub picture: u32,
    /// Its place among the detections of its picture and class, best first.
    pub rank: u32,
    pub verdict: Verdict,
}

impl Ranked {
    /// By falling score; equal ones by picture, then by rank: the stable merge sort of pycocotools.
    pub(super) fn before(&self, other: &Self) -> std::cmp::Ordering {
        let scores = other.score.partial_cmp(&self.score).unwrap_or(std::cmp::Ordering::Equal);
        scores.then(self.picture.cmp(&other.picture)).then(self.rank.cmp(&other.rank))
    }
}

/// Precision over recall and the highest recall of one class and range of area, at every threshold.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Curve {
    pub precision: [[f64; RECALLS]; THRESHOLDS],
    pub recall: [f64; THRESHOLDS],
}

impl Curve {
    /// `ranked` in its order; `truths` objects count, at least one.
    pub(super) fn of<'a>(ranked: impl IntoIterator<Item = &'a Ranked>, area: usize, truths: u64) -> Self {
        let mut wrong_everywhere = 0u64;
        let mut wrong = [0u64; THRESHOLDS];
        // Precision only rises where something is found: what matters is how much was wrong before each find.
        let mut finds: [Vec<f64>; THRESHOLDS] = Default::default();
        for Ranked { verdict, .. } in ranked {
            let (right, ignored) = (verdict.right[area], verdict.ignored[area]);
            if right | ignored == 0 {
                wrong_everywhere += 1;
                continue;
            }
            for bit in 0..THRESHOLDS {
                if right >> bit & 1 == 1 {
                    let found = (finds[bit].len() + 1) as f64;
                    finds[bit].push(found / ((wrong_everywhere + wrong[bit]) as f64 + found + f64::EPSILON));
                } else if ignored >> bit & 1 == 0 {
                    wrong[bit] += 1;
                }
            }
        }
        let mut curve = Self { precision: [[0.0; RECALLS]; THRESHOLDS], recall: [0.0; THRESHOLDS] };
        for (bit, precision) in finds.iter_mut().enumerate() {
            curve.recall[bit] = precision.len() as f64 / truths as f64;
            curve.precision[bit] = interpolated(precision, truths);
        }
        curve
    }

    /// Average precision at a threshold.
    pub(super) fn average(&self, threshold: usize) -> f64 {
        self.precision[threshold].iter().sum::<f64>() / RECALLS as f64
    }

    /// Average precision over all thresholds.
    pub(super) fn mean(&self) -> f64 {
        (0..THRESHOLDS).map(|threshold| self.average(threshold)).sum::<f64>() / THRESHOLDS as f64
    }
}

/// The highest precision at each level of recall or above, from the precision at each find.
fn interpolated(precision: &mut [f64], truths: u64) -> [f64; RECALLS] {
    let mut highest = 0.0f64;
    for precision in precision.iter_mut().rev() {
        highest = highest.max(*precision);
        *precision = highest;
    }
    let mut find = 0;
    recalls().map(|level| {
        while find < precision.len() && ((find + 1) as f64 / truths as f64) < level {
            find += 1;
        }
        precision.get(find).copied().unwrap_or_default()
    })
}
