use super::candidate::{Candidate, overlap};
use super::greedy::keep_unmarked;

/// Applies Fast NMS in which only kept boxes suppress others, repeated until nothing changes. A change propagates by at least one
/// box per pass, so there are at most as many passes as boxes; clusters are small in practice.
pub fn suppress(candidates: &mut Vec<Candidate>, dropped: &mut Vec<bool>, limit: f32) {
    dropped.clear();
    dropped.resize(candidates.len(), false);
    loop {
        let mut changed = false;
        // Lowest score first, so that each pass reads the marks of the previous one.
        for at in (0..candidates.len()).rev() {
            let this = &candidates[at];
            let drop = (0..at).any(|better| !dropped[better] && overlap(&candidates[better], this, limit));
            changed |= drop != dropped[at];
            dropped[at] = drop;
        }
        if !changed {
            break;
        }
    }
    keep_unmarked(candidates, dropped);
}
