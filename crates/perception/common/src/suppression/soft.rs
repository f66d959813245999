use super::candidate::{Candidate, by_score, iou};

/// Sigma of the Gaussian that lowers scores.
const SIGMA: f32 = 0.5;

/// Applies Soft-NMS: the box with the highest score lowers the scores of those that overlap it, then the next by the new scores.
pub fn suppress(candidates: &mut Vec<Candidate>, threshold: f32, most: usize) {
    let mut done = 0;
    while done < candidates.len() && done < most {
        let rest = &candidates[done..];
        let ahead = rest.iter().enumerate().min_by(|a, b| by_score(a.1, b.1)).map_or(0, |(ahead, _)| ahead);
        candidates.swap(done, done + ahead);
        let best = candidates[done];
        done += 1;
        let mut at = done;
        while at < candidates.len() {
            let other = &mut candidates[at];
            if other.class == best.class {
                let shared = iou(&best.corners, &other.corners);
                other.score *= (-shared * shared / SIGMA).exp();
            }
            if other.score < threshold {
                candidates.swap_remove(at);
            } else {
                at += 1;
            }
        }
    }
    candidates.truncate(done);
}
