use super::candidate::{Candidate, overlap};
use super::greedy::keep_unmarked;

/// Drops every box that a box of a higher score overlaps, even if that one is dropped itself.
pub fn suppress(candidates: &mut Vec<Candidate>, dropped: &mut Vec<bool>, limit: f32) {
    dropped.clear();
    dropped.extend((0..candidates.len()).map(|at| {
        let (better, this) = (&candidates[..at], &candidates[at]);
        better.iter().any(|candidate| overlap(candidate, this, limit))
    }));
    keep_unmarked(candidates, dropped);
}
