//! Precision-recall curves from ranked matches.

use super::matching::Verdict;
use super::protocol::{RECALLS, THRESHOLDS, recalls};

/// A matched detection with its position in the ranking.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ranked {
    pub score: f64,
    /// Index of its image.
    pub image: u32,
    /// Rank among the detections of its image and class, best first.
    pub rank: u32,
    pub verdict: Verdict,
}

impl Ranked {
    /// Compares by descending score, then by image, then by rank, as the stable merge sort of pycocotools.
    pub(super) fn before(&self, other: &Self) -> std::cmp::Ordering {
        let scores = other.score.partial_cmp(&self.score).unwrap_or(std::cmp::Ordering::Equal);
        scores.then(self.image.cmp(&other.image)).then(self.rank.cmp(&other.rank))
    }
}

/// Precision at each level of recall, and the highest recall, of one class and range of area, at every threshold.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Curve {
    pub precision: [[f64; RECALLS]; THRESHOLDS],
    pub recall: [f64; THRESHOLDS],
}

impl Curve {
    /// Computes the curve of ranked detections for `ground_truths` objects, at least one.
    pub(super) fn of<'a>(
        ranked: impl IntoIterator<Item = &'a Ranked>,
        area: usize,
        ground_truths: u64,
    ) -> Self {
        let mut false_everywhere = 0u64;
        let mut false_positives = [0u64; THRESHOLDS];
        // Precision rises only at true positives, so only the number of false positives before each of them matters.
        let mut hit_precisions: [Vec<f64>; THRESHOLDS] = Default::default();
        for Ranked { verdict, .. } in ranked {
            let (correct, ignored) = (verdict.correct[area], verdict.ignored[area]);
            if correct | ignored == 0 {
                false_everywhere += 1;
                continue;
            }
            for bit in 0..THRESHOLDS {
                if correct >> bit & 1 == 1 {
                    let hits = (hit_precisions[bit].len() + 1) as f64;
                    hit_precisions[bit].push(
                        hits / ((false_everywhere + false_positives[bit]) as f64 + hits + f64::EPSILON),
                    );
                } else if ignored >> bit & 1 == 0 {
                    false_positives[bit] += 1;
                }
            }
        }
        let mut curve = Self { precision: [[0.0; RECALLS]; THRESHOLDS], recall: [0.0; THRESHOLDS] };
        for (bit, precision) in hit_precisions.iter_mut().enumerate() {
            curve.recall[bit] = precision.len() as f64 / ground_truths as f64;
            curve.precision[bit] = interpolated(precision, ground_truths);
        }
        curve
    }

    /// Returns the average precision at a threshold.
    pub(super) fn average(&self, threshold: usize) -> f64 {
        self.precision[threshold].iter().sum::<f64>() / RECALLS as f64
    }

    /// Returns the mean of the average precisions over all thresholds.
    pub(super) fn mean(&self) -> f64 {
        (0..THRESHOLDS).map(|threshold| self.average(threshold)).sum::<f64>() / THRESHOLDS as f64
    }
}

/// Returns the highest precision at each level of recall or above, from the precision at each true positive.
fn interpolated(precision: &mut [f64], ground_truths: u64) -> [f64; RECALLS] {
    let mut highest = 0.0f64;
    for precision in precision.iter_mut().rev() {
        highest = highest.max(*precision);
        *precision = highest;
    }
    let mut hit = 0;
    recalls().map(|level| {
        while hit < precision.len() && ((hit + 1) as f64 / ground_truths as f64) < level {
            hit += 1;
        }
        precision.get(hit).copied().unwrap_or_default()
    })
}
