//! Non-maximum suppression: removal of boxes that overlap a box of a higher score.

mod birds_eye_view;
mod candidate;
mod cluster;
mod fast;
mod greedy;
mod hard;
mod soft;
mod weighted;

pub use birds_eye_view::{BevCandidate, suppress_bev};
pub use candidate::{Candidate, iou, keep_best};
pub use weighted::merge_overlapping;

use candidate::by_score;

opendr_engine::choices! {
    /// Method of non-maximum suppression.
    pub enum SuppressionKind {
        /// The box with the highest score drops all that overlap it (greedy NMS).
        Hard = "hard",
        /// The box with the highest score lowers the scores of those that overlap it, by `exp(-IoU^2 / sigma)` with sigma
        /// 0.5 (Soft-NMS, Bodla et al., ICCV 2017, Eq. 3).
        Soft = "soft",
        /// All boxes drop those that they overlap, dropped boxes too: one pass, slightly too strict (Fast NMS, Bolya et
        /// al., YOLACT, ICCV 2019).
        Fast = "fast",
        /// Fast NMS repeated until nothing changes: the result of `hard`, in a few passes (Cluster-NMS, Zheng et al.,
        /// IEEE Trans. Cybernetics 2022, Algorithm 1).
        Cluster = "cluster",
    }
}

/// Settings of a non-maximum suppression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Suppression {
    /// The method.
    pub kind: SuppressionKind,
    /// IoU above which boxes overlap.
    pub iou_threshold: f32,
    /// Score below which boxes are dropped; only `soft` lowers scores.
    pub threshold: f32,
    /// Maximum number of boxes that are kept.
    pub max_boxes: usize,
}

/// Number of candidates with the highest scores that are processed. Further ones are noise, and time grows with the square.
const CONSIDERED: usize = 1000;

impl Suppression {
    /// Suppresses `candidates` in place and leaves them sorted by score, highest first. `marks` is work memory.
    ///
    /// Candidates with NaN or infinite values are dropped.
    pub fn run(&self, candidates: &mut Vec<Candidate>, marks: &mut Vec<bool>) {
        candidates.retain(|candidate| {
            candidate.score >= self.threshold && candidate.corners.iter().all(|edge| edge.is_finite())
        });
        keep_best(candidates, CONSIDERED);
        candidates.sort_unstable_by(by_score);
        match self.kind {
            SuppressionKind::Hard => hard::suppress(candidates, marks, self.iou_threshold, self.max_boxes),
            SuppressionKind::Soft => soft::suppress(candidates, self.threshold, self.max_boxes),
            SuppressionKind::Fast => fast::suppress(candidates, marks, self.iou_threshold),
            SuppressionKind::Cluster => cluster::suppress(candidates, marks, self.iou_threshold),
        }
        candidates.truncate(self.max_boxes);
    }
}

#[cfg(test)]
mod tests;
