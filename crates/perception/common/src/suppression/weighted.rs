use super::candidate::{Candidate, by_score, overlap};

/// Applies weighted NMS (Bazarevsky et al., BlazeFace, 2019): the box with the highest score forms a group with those that overlap
/// it by more than `limit`, then the next that is left. `merge` receives each group, highest score first, and blends it by
/// scores.
///
/// `candidates` is empty afterwards; `members` is work memory.
pub fn merge_overlapping(
    candidates: &mut Vec<Candidate>,
    members: &mut Vec<Candidate>,
    limit: f32,
    mut merge: impl FnMut(&[Candidate]),
) {
    candidates.sort_unstable_by(by_score);
    while let Some(best) = candidates.first().copied() {
        members.clear();
        let mut first = true;
        candidates.retain(|candidate| {
            let same = std::mem::take(&mut first) || overlap(&best, candidate, limit);
            if same {
                members.push(*candidate);
            }
            !same
        });
        merge(members);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_box_is_merged_once() {
        let at = |left: f32, score: f32, index: u32| Candidate {
            corners: [left, 0.0, left + 10.0, 10.0],
            score,
            index,
            ..Candidate::default()
        };
        let mut candidates = vec![at(100.0, 0.5, 0), at(1.0, 0.8, 1), at(0.0, 0.9, 2), at(3.0, 0.7, 3)];
        let mut groups = Vec::new();
        merge_overlapping(&mut candidates, &mut Vec::new(), 0.3, |members| {
            groups.push(members.iter().map(|member| member.index).collect::<Vec<_>>());
        });
        assert_eq!(groups, [vec![2, 1, 3], vec![0]]);
        // A box without area overlaps nothing, not even itself.
        let mut empty = vec![Candidate::default()];
        let mut count = 0;
        merge_overlapping(&mut empty, &mut Vec::new(), 0.3, |members| count += members.len());
        assert_eq!((count, empty.len()), (1, 0));
    }
}
