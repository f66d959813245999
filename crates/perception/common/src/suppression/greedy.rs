//! The loop of greedy suppression, over candidates of any kind.

/// Marks the candidates that greedy NMS drops: each candidate that is not marked, in the order of `candidates`, marks those after
/// it that `overlaps` it; from the `most + 1`-th kept candidate on all are marked.
///
/// `candidates` are sorted by score, highest first; `dropped` is work memory and receives a mark for each.
pub fn mark<T>(candidates: &[T], dropped: &mut Vec<bool>, most: usize, overlaps: impl Fn(&T, &T) -> bool) {
    dropped.clear();
    dropped.resize(candidates.len(), false);
    let mut kept = 0;
    for (best, candidate) in candidates.iter().enumerate() {
        if dropped[best] {
            continue;
        }
        kept += 1;
        if kept > most {
            dropped[best..].fill(true);
            break;
        }
        for (other, mark) in candidates.iter().zip(&mut *dropped).skip(best + 1) {
            *mark = *mark || overlaps(candidate, other);
        }
    }
}

/// Keeps the candidates whose mark is not set.
pub fn keep_unmarked<T>(candidates: &mut Vec<T>, marks: &[bool]) {
    let mut dropped = marks.iter();
    candidates.retain(|_| !dropped.next().copied().unwrap_or(false));
}
