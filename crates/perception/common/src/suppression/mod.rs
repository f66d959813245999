//! Non-maximum suppression: removal of boxes that overlap a box of a higher score.

mod cluster;
mod fast;
mod hard;
mod soft;
mod standing;
mod weighted;

pub use standing::{BevCandidate, suppress_bev};
pub use weighted::merge_overlapping;

/// A box before suppression.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Candidate {
    /// Corners `[x0, y0, x1, y1]`, in pixels of any one coordinate frame.
    pub corners: [f32; 4],
    /// Score, 0..=1.
    pub score: f32,
    /// Class index; boxes of different classes never suppress each other.
    pub class: u32,
    /// Index of the box for the caller, to look up other data of it.
    pub index: u32,
}

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

/// Keeps the `most` candidates with the highest scores, in any order.
pub fn keep_best(candidates: &mut Vec<Candidate>, most: usize) {
    if candidates.len() > most {
        candidates.select_nth_unstable_by(most, by_score);
        candidates.truncate(most);
    }
}

/// Compares by descending score, then by class and index, so that the order is deterministic.
fn by_score(a: &Candidate, b: &Candidate) -> std::cmp::Ordering {
    b.score.total_cmp(&a.score).then(a.class.cmp(&b.class)).then(a.index.cmp(&b.index))
}

/// Intersection over union of two boxes `[x0, y0, x1, y1]`; 0 when both are empty.
pub fn iou(a: &[f32; 4], b: &[f32; 4]) -> f32 {
    let width = (a[2].min(b[2]) - a[0].max(b[0])).max(0.0);
    let height = (a[3].min(b[3]) - a[1].max(b[1])).max(0.0);
    let area = |edges: &[f32; 4]| (edges[2] - edges[0]).max(0.0) * (edges[3] - edges[1]).max(0.0);
    let intersection = width * height;
    let union = area(a) + area(b) - intersection;
    if union > 0.0 { intersection / union } else { 0.0 }
}

fn overlap(a: &Candidate, b: &Candidate, limit: f32) -> bool {
    a.class == b.class && iou(&a.corners, &b.corners) > limit
}

/// Keeps the candidates whose mark is not set.
fn keep_unmarked(candidates: &mut Vec<Candidate>, marks: &[bool]) {
    let mut dropped = marks.iter();
    candidates.retain(|_| !dropped.next().copied().unwrap_or(false));
}

#[cfg(test)]
mod tests;
