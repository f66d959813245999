use super::candidate::{Candidate, overlap};
use super::greedy::{keep_unmarked, mark};

/// Applies greedy NMS: the box with the highest score drops all that overlap it, then the next that is left.
pub fn suppress(candidates: &mut Vec<Candidate>, dropped: &mut Vec<bool>, limit: f32, most: usize) {
    mark(candidates, dropped, most, |best, other| overlap(best, other, limit));
    keep_unmarked(candidates, dropped);
}
