use super::candidate::{Candidate, keep_unmarked, overlap};

/// Applies greedy NMS: the box with the highest score drops all that overlap it, then the next that is left.
pub fn suppress(candidates: &mut Vec<Candidate>, dropped: &mut Vec<bool>, limit: f32, most: usize) {
    dropped.clear();
    dropped.resize(candidates.len(), false);
    let mut kept = 0;
    for best in 0..candidates.len() {
        if dropped[best] {
            continue;
        }
        kept += 1;
        if kept > most {
            dropped[best..].fill(true);
            break;
        }
        for other in best + 1..candidates.len() {
            dropped[other] |= overlap(&candidates[best], &candidates[other], limit);
        }
    }
    keep_unmarked(candidates, dropped);
}
