//! Boxes before suppression.

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

/// Keeps the `most` candidates with the highest scores, in any order.
pub fn keep_best(candidates: &mut Vec<Candidate>, most: usize) {
    if candidates.len() > most {
        candidates.select_nth_unstable_by(most, by_score);
        candidates.truncate(most);
    }
}

/// Compares by descending score, then by class and index, so that the order is deterministic.
pub(super) fn by_score(a: &Candidate, b: &Candidate) -> std::cmp::Ordering {
    b.score.total_cmp(&a.score).then(a.class.cmp(&b.class)).then(a.index.cmp(&b.index))
}

/// Returns the intersection over union of two boxes `[x0, y0, x1, y1]`; 0 when both are empty.
pub fn iou(a: &[f32; 4], b: &[f32; 4]) -> f32 {
    let width = (a[2].min(b[2]) - a[0].max(b[0])).max(0.0);
    let height = (a[3].min(b[3]) - a[1].max(b[1])).max(0.0);
    let area = |edges: &[f32; 4]| (edges[2] - edges[0]).max(0.0) * (edges[3] - edges[1]).max(0.0);
    let intersection = width * height;
    let union = area(a) + area(b) - intersection;
    if union > 0.0 { intersection / union } else { 0.0 }
}

/// Returns whether two boxes of a class overlap by more than `limit`.
pub(super) fn overlap(a: &Candidate, b: &Candidate, limit: f32) -> bool {
    a.class == b.class && iou(&a.corners, &b.corners) > limit
}
