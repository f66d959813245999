//! Precision over recall, and its mean.

use super::frame::{Frame, Matched};
use super::rules::{KittiClass, KittiDifficulty, KittiOverlap, Rules};

/// Recall is looked at in 40 steps from 0 to 1.
const RECALL_POINTS: usize = 41;

/// Average precision of one class, kind of overlap and difficulty.
#[derive(Debug, Clone, PartialEq)]
pub struct KittiScore {
    /// Of what.
    pub class: KittiClass,
    /// By which overlap.
    pub overlap: KittiOverlap,
    /// With which truth.
    pub difficulty: KittiDifficulty,
    /// Boxes match that overlap by more than this.
    pub least_overlap: f64,
    /// Whether that is the smaller of the two limits in use.
    pub is_loose: bool,
    /// Best precision at recall 0, 1/40 to 1 or beyond.
    pub precision: [f64; RECALL_POINTS],
    /// The same of orientation similarity; of boxes in the picture, where all have an orientation.
    pub orientation: Option<[f64; RECALL_POINTS]>,
}

impl KittiScore {
    /// Kind (`"2d"`, `"bev"`, `"3d"`, `"aos"`), mean over 11 and over 40 recall points, 0 to 1.
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

/// Recall 0 is left out.
fn mean_of_40(values: &[f64; RECALL_POINTS]) -> f64 {
    values[1..].iter().sum::<f64>() / 40.0
}

/// The score under `rules`; `None` where no truth is asked for.
pub(super) fn curves(frames: &[&Frame], rules: &Rules, with_orientation: bool) -> Option<KittiScore> {
    let asked_for: usize = frames.iter().map(|frame| frame.asked_for(rules)).sum();
    if asked_for == 0 {
        return None;
    }
    let mut scores = Vec::new();
    frames.iter().for_each(|frame| frame.true_scores(rules, &mut scores));
    let mut precision = [0.0; RECALL_POINTS];
    let mut orientation = precision;
    for (at, threshold) in thresholds(scores, asked_for).into_iter().enumerate() {
        let mut sum = Matched::default();
        for frame in frames {
            let matched = frame.matched(rules, threshold);
            sum.true_positives += matched.true_positives;
            sum.false_positives += matched.false_positives;
            sum.similarity += matched.similarity;
        }
        let answers = (sum.true_positives + sum.false_positives).max(1) as f64;
        precision[at] = sum.true_positives as f64 / answers;
        orientation[at] = sum.similarity / answers;
    }
    let Rules { class, overlap, difficulty, is_loose } = *rules;
    Some(KittiScore {
        class,
        overlap,
        difficulty,
        least_overlap: rules.least_overlap(),
        is_loose,
        precision: best_from_here_on(precision),
        orientation: (with_orientation && overlap == KittiOverlap::Image)
            .then(|| best_from_here_on(orientation)),
    })
}

/// The scores at which recall comes nearest to its steps.
fn thresholds(mut scores: Vec<f64>, asked_for: usize) -> Vec<f64> {
    scores.sort_by(|a, b| b.total_cmp(a));
    let (mut thresholds, mut wanted) = (Vec::with_capacity(RECALL_POINTS), 0.0);
    for (at, score) in scores.iter().enumerate() {
        let (here, next) = ((at + 1) as f64 / asked_for as f64, (at + 2) as f64 / asked_for as f64);
        let is_last = at + 1 == scores.len();
        if !is_last && next - wanted < wanted - here {
            continue;
        }
        thresholds.push(*score);
        wanted += 1.0 / (RECALL_POINTS - 1) as f64;
    }
    thresholds.truncate(RECALL_POINTS);
    thresholds
}

fn best_from_here_on(mut values: [f64; RECALL_POINTS]) -> [f64; RECALL_POINTS] {
    for at in (1..RECALL_POINTS).rev() {
        values[at - 1] = values[at - 1].max(values[at]);
    }
    values
}
