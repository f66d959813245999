//! Decoding of the network's maps to boxes before non-maximum suppression.

use opendr_engine::target::LidarBox;

use super::coding::{NUMBERS, box_from_offsets};
use super::layout::PillarLayout;

/// Output maps of the network for one scan, row-major.
#[derive(Debug, Clone, Copy)]
pub struct PillarMaps<'a> {
    /// Score logits, one map per anchor.
    pub scores: &'a [f32],
    /// Offsets, seven maps per anchor.
    pub offsets: &'a [f32],
    /// Direction logits, one map per anchor; above 0 for backward.
    pub directions: &'a [f32],
}

/// A decoded box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DecodedBox {
    /// Position, size and yaw in the lidar's frame.
    pub place: LidarBox,
    /// Score, 0..=1.
    pub score: f32,
    /// Class index.
    pub class: u32,
}

impl PillarMaps<'_> {
    /// Appends the boxes whose score reaches `threshold` to `found`.
    ///
    /// Scores are compared as logits, so that only boxes above the threshold cost an exponential.
    pub fn decode(&self, layout: &PillarLayout, threshold: f32, found: &mut Vec<DecodedBox>) {
        let [columns, rows] = layout.maps();
        let cells = (columns * rows).max(1);
        let least = (threshold / (1.0 - threshold)).ln();
        let maps = self.scores.chunks_exact(cells).zip(self.offsets.chunks_exact(NUMBERS * cells));
        let maps = maps.zip(self.directions.chunks_exact(cells));
        for (kind, ((scores, offsets), backs)) in layout.anchors.iter().zip(maps) {
            for (cell, score) in scores.iter().enumerate().filter(|(_, score)| **score >= least) {
                let anchor = kind.at(layout.middle(cell % columns, cell / columns));
                let offsets = std::array::from_fn(|number| offsets[number * cells + cell]);
                let score = 1.0 / (1.0 + (-score).exp());
                let place = box_from_offsets(offsets, backs[cell], &anchor);
                found.push(DecodedBox { place, score, class: kind.class as u32 });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::anchors::AnchorKind;
    use super::*;
    use crate::pillars::PillarGrid;

    #[test]
    fn a_cell_decodes_to_a_box() {
        let grid = PillarGrid { x: [0.0, 6.0], y: [-2.0, 2.0], z: [-3.0, 1.0], side: 1.0 };
        let anchors = AnchorKind::of_class("Car", 0).unwrap().to_vec();
        let layout = PillarLayout { grid, stride: 2, anchors };
        assert_eq!(layout.maps(), [3, 2]);
        let (mut scores, mut offsets, mut backs) = (vec![-9.0; 12], vec![0.0; 84], vec![-1.0; 12]);
        // The second anchor, column 1 of row 1.
        (scores[6 + 4], backs[6 + 4]) = (2.0, 1.0);
        offsets[(7 + 3) * 6 + 4] = std::f32::consts::LN_2;
        let maps = PillarMaps { scores: &scores, offsets: &offsets, directions: &backs };
        let mut found = Vec::new();
        maps.decode(&layout, 0.5, &mut found);
        let [found] = found[..] else { panic!("{found:?}") };
        assert_eq!((found.class, found.place.center[..2].to_vec()), (0, vec![3.0, 1.0]));
        assert!((found.place.size[0] - 7.8).abs() < 1e-5);
        // Along y, backward.
        assert!((found.place.yaw + std::f64::consts::FRAC_PI_2).abs() < 1e-6, "{}", found.place.yaw);
        assert!((found.score - 0.880_797).abs() < 1e-5);
    }
}
