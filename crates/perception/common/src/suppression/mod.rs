//! Non-maximum suppression: from the many boxes that a detector gives to one box per object.

mod cluster;
mod fast;
mod hard;
mod soft;
mod standing;
mod weighted;

pub use standing::{StandingCandidate, suppress_standing};
pub use weighted::merge_overlapping;

/// A box before suppression.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Candidate {
    /// `[x0, y0, x1, y1]`, in whatever pixels the caller uses.
    pub corners: [f32; 4],
    /// Score, 0..=1.
    pub score: f32,
    /// Class number; boxes of different classes never suppress each other.
    pub class: u32,
    /// The caller's number of the box, to find what else belongs to it.
    pub index: u32,
}

opendr_engine::choices! {
    /// How boxes that overlap are thinned out.
    pub enum SuppressionKind {
        /// The best box drops all that overlap it (greedy NMS).
        Hard = "hard",
        /// The best box lowers the scores of those that overlap it, by `exp(-IoU^2 / sigma)` with sigma 0.5
        /// (Soft-NMS, Bodla et al., ICCV 2017, Eq. 3).
        Soft = "soft",
        /// All boxes drop what overlaps them, dropped ones too: one pass, slightly too strict (Fast NMS, Bolya et al.,
        /// YOLACT, ICCV 2019).
        Fast = "fast",
        /// Fast NMS repeated until nothing changes: the result of `hard`, in a few passes (Cluster-NMS, Zheng et al.,
        /// IEEE Trans. Cybernetics 2022, Algorithm 1).
        Cluster = "cluster",
    }
}

/// A suppression with its settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Suppression {
    /// The method.
    pub kind: SuppressionKind,
    /// Boxes overlap when their intersection over union is above this.
    pub overlap: f32,
    /// Boxes below this score are dropped; only `soft` lowers scores.
    pub threshold: f32,
    /// How many boxes stay at most.
    pub most: usize,
}

/// How many of the best candidates are looked at: beyond that a network gives noise, and time grows with the square.
const CONSIDERED: usize = 1000;

impl Suppression {
    /// Thins `candidates` out in place and leaves them sorted, best first. `marks` is work memory.
    ///
    /// Candidates with NaN or infinite numbers are dropped.
    pub fn run(&self, candidates: &mut Vec<Candidate>, marks: &mut Vec<bool>) {
        candidates.retain(|candidate| {
            candidate.score >= self.threshold && candidate.corners.iter().all(|edge| edge.is_finite())
        });
        keep_best(candidates, CONSIDERED);
        candidates.sort_unstable_by(by_score);
        match self.kind {
            SuppressionKind::Hard => hard::suppress(candidates, marks, self.overlap, self.most),
            SuppressionKind::Soft => soft::suppress(candidates, self.threshold, self.most),
            SuppressionKind::Fast => fast::suppress(candidates, marks, self.overlap),
            SuppressionKind::Cluster => cluster::suppress(candidates, marks, self.overlap),
        }
        candidates.truncate(self.most);
    }
}

/// Keeps the `most` best candidates, in any order.
pub fn keep_best(candidates: &mut Vec<Candidate>, most: usize) {
    if candidates.len() > most {
        candidates.select_nth_unstable_by(most, by_score);
        candidates.truncate(most);
    }
}

/// Best first; equal scores by class and number, so that the order never depends on the sort.
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
