//! Precision-recall curves and their mean.

use super::frame::{Frame, Matched};
use super::rules::{KittiClass, KittiDifficulty, KittiOverlap, Rules};

/// Number of levels of recall, in 40 steps from 0 to 1.
const RECALL_POINTS: usize = 41;

/// Average precision of one class, kind of overlap and difficulty.
#[derive(Debug, Clone, PartialEq)]
pub struct KittiScore {
    /// Class.
    pub class: KittiClass,
    /// Kind of overlap.
    pub overlap: KittiOverlap,
    /// Difficulty of the ground truth.
    pub difficulty: KittiDifficulty,
    /// Limit of the overlap: matching boxes overlap by more.
    pub overlap_threshold: f64,
    /// Whether that is the lower one of the two common limits.
    pub is_loose: bool,
    /// Highest precision at recall 0, 1/40 to 1 or above.
    pub precision: [f64; RECALL_POINTS],
    /// Highest orientation similarity at these recalls; for boxes in the image, if all have an orientation.
    pub orientation: Option<[f64; RECALL_POINTS]>,
}

impl KittiScore {
    /// Returns kind (`"2d"`, `"bev"`, `"3d"`, `"aos"`) and mean over 11 and over 40 recall points, 0 to 1.
    pub fn numbers(&self) -> impl Iterator<Item = (&'static str, f64, f64)> {
        let precision = (self.overlap.name(), mean_of_11(&self.precision), mean_of_40(&self.precision));
        let orientation =
            self.orientation.as_ref().map(|values| ("aos", mean_of_11(values), mean_of_40(values)));
        std::iter::once(precision).chain(orientation)
    }

    pub(super) fn suffix(&self) -> &'static str {
        if self.is_loose { "_loose" } else { "" }
    }
}

fn mean_of_11(values: &[f64; RECALL_POINTS]) -> f64 {
    values.iter().step_by(4).sum::<f64>() / 11.0
}

/// Returns the mean without recall 0.
fn mean_of_40(values: &[f64; RECALL_POINTS]) -> f64 {
    values[1..].iter().sum::<f64>() / 40.0
}

/// Computes the score under `rules`; `None` without ground truth that counts.
pub(super) fn curves(frames: &[&Frame], rules: &Rules, with_orientation: bool) -> Option<KittiScore> {
    let positives: usize = frames.iter().map(|frame| frame.positives(rules)).sum();
    if positives == 0 {
        return None;
    }
    let mut scores = Vec::new();
    frames.iter().for_each(|frame| frame.true_scores(rules, &mut scores));
    let mut precision = [0.0; RECALL_POINTS];
    let mut orientation = precision;
    for (at, threshold) in thresholds(scores, positives).into_iter().enumerate() {
        let mut sum = Matched::default();
        for frame in frames {
            let matched = frame.matched(rules, threshold);
            sum.true_positives += matched.true_positives;
            sum.false_positives += matched.false_positives;
            sum.similarity += matched.similarity;
        }
        let predictions = (sum.true_positives + sum.false_positives).max(1) as f64;
        precision[at] = sum.true_positives as f64 / predictions;
        orientation[at] = sum.similarity / predictions;
    }
    let Rules { class, overlap, difficulty, is_loose } = *rules;
    Some(KittiScore {
        class,
        overlap,
        difficulty,
        overlap_threshold: rules.least_overlap(),
        is_loose,
        precision: running_maximum(precision),
        orientation: (with_orientation && overlap == KittiOverlap::Image)
            .then(|| running_maximum(orientation)),
    })
}

/// Returns the scores at which recall is nearest to its levels.
fn thresholds(mut scores: Vec<f64>, positives: usize) -> Vec<f64> {
    scores.sort_by(|a, b| b.total_cmp(a));
    let (mut thresholds, mut level) = (Vec::with_capacity(RECALL_POINTS), 0.0);
    for (at, score) in scores.iter().enumerate() {
        let (here, next) = ((at + 1) as f64 / positives as f64, (at + 2) as f64 / positives as f64);
        let is_last = at + 1 == scores.len();
        if !is_last && next - level < level - here {
            continue;
        }
        thresholds.push(*score);
        level += 1.0 / (RECALL_POINTS - 1) as f64;
    }
    thresholds.truncate(RECALL_POINTS);
    thresholds
}

fn running_maximum(mut values: [f64; RECALL_POINTS]) -> [f64; RECALL_POINTS] {
    for at in (1..RECALL_POINTS).rev() {
        values[at - 1] = values[at - 1].max(values[at]);
    }
    values
}
