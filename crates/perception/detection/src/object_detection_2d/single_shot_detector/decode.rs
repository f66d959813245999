//! Decoding of a network's outputs to boxes before suppression.

use opendr_perception_common::suppression::Candidate;

use super::anchors::AnchorLevel;
use super::coding::corners_from_offsets;

/// The outputs of one level, each row by row.
#[derive(Debug, Clone, Copy)]
pub struct LevelMaps<'a> {
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Logits of the scores: for each kind of anchor a map per class.
    pub scores: &'a [f32],
    /// Offsets: for each kind of anchor four maps.
    pub offsets: &'a [f32],
}

impl LevelMaps<'_> {
    /// Adds the boxes whose score reaches `threshold` to `candidates`, in pixels of the network's input.
    ///
    /// Scores are compared as logits, so only those that reach the threshold cost an exponential.
    pub fn decode(
        &self,
        level: &AnchorLevel,
        classes: usize,
        threshold: f32,
        candidates: &mut Vec<Candidate>,
    ) {
        let cells = (self.columns * self.rows).max(1);
        let least = logit(threshold);
        let scores = self.scores.chunks_exact(cells * classes.max(1));
        let kinds = level.sides.iter().zip(scores).zip(self.offsets.chunks_exact(4 * cells));
        for ((sides, scores), offsets) in kinds {
            for (class, map) in scores.chunks_exact(cells).enumerate() {
                if !any_reaches(map, least) {
                    continue;
                }
                let reach = map.iter().enumerate().filter(|(_, score)| **score >= least);
                candidates.extend(reach.map(|(cell, score)| {
                    let anchor = level.anchor(*sides, cell % self.columns, cell / self.columns);
                    let offsets = std::array::from_fn(|at| offsets[at * cells + cell]);
                    Candidate {
                        corners: corners_from_offsets(offsets, &anchor),
                        score: sigmoid(*score),
                        class: class as u32,
                        index: cell as u32,
                    }
                }));
            }
        }
    }
}

/// Returns whether any score reaches the threshold. Most maps are empty, and this runs over all of them.
fn any_reaches(scores: &[f32], least: f32) -> bool {
    scores.iter().fold(false, |any, score| any | (*score >= least))
}

fn sigmoid(logit: f32) -> f32 {
    1.0 / (1.0 + (-logit).exp())
}

fn logit(probability: f32) -> f32 {
    (probability / (1.0 - probability)).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_becomes_a_box() {
        let level = AnchorLevel { stride: 16, sides: vec![[16.0, 16.0], [8.0, 32.0]] };
        let (mut scores, mut offsets) = (vec![-9.0; 2 * 3 * 6], vec![0.0; 2 * 4 * 6]);
        // The second kind, class 2, column 1 of row 1 in maps of 3 x 2.
        scores[(3 + 2) * 6 + 4] = 2.0;
        offsets[(4 + 1) * 6 + 4] = 5.0;
        let maps = LevelMaps { columns: 3, rows: 2, scores: &scores, offsets: &offsets };
        let mut candidates = Vec::new();
        maps.decode(&level, 3, 0.5, &mut candidates);
        let [found] = candidates[..] else { panic!("{candidates:?}") };
        assert_eq!((found.class, found.corners), (2, [20.0, 24.0, 28.0, 56.0]));
        assert!((found.score - 0.880_797).abs() < 1e-6);
    }

    #[test]
    fn thresholds_are_met_at_both_ends() {
        let level = AnchorLevel { stride: 8, sides: vec![[8.0, 8.0]] };
        let maps = LevelMaps { columns: 2, rows: 1, scores: &[-90.0, 90.0], offsets: &[0.0; 8] };
        for (threshold, count) in [(0.0, 2), (0.5, 1), (1.0, 0)] {
            let mut candidates = Vec::new();
            maps.decode(&level, 1, threshold, &mut candidates);
            assert_eq!(candidates.len(), count, "{threshold}");
        }
    }
}
