use super::{Candidate, keep_unmarked, overlap};

/// Fast NMS in which only boxes still kept may drop others, repeated until nothing changes. A change moves on by at
/// least one box a pass, so it ends after at most as many passes as there are boxes; clusters are small in practice.
pub fn suppress(candidates: &mut Vec<Candidate>, dropped: &mut Vec<bool>, limit: f32) {
    dropped.clear();
    dropped.resize(candidates.len(), false);
    loop {
        let mut changed = false;
        // From the worst up, so that each pass sees the marks of the pass before.
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
