//! Assignment of cells to boxes: adaptive training sample selection (Zhang et al., Bridging the gap between anchor-based
//! and anchor-free detection, CVPR 2020, Algorithm 1).

use std::collections::BTreeMap;

use crate::object_detection_2d::ground_truth::{GroundTruthBox, iou};

/// Number of cells per level, nearest to a box, that are candidates for it.
const NEAREST: usize = 9;
/// Side of the square around a cell that is compared with boxes, in strides.
const SQUARE: f32 = 8.0;
/// Minimum distance of a cell's point from the sides of its box, in pixels.
const INSIDE: f32 = 0.01;

/// A cell that is assigned to a box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Positive {
    /// Index of the cell: level by level, fine to coarse, row by row.
    pub cell: usize,
    /// Class index of the box.
    pub class: usize,
    /// Distances from the cell's point to the left, top, right and bottom side, in strides of its level; all above 0.
    pub distances: [f32; 4],
}

/// The grids of cells of all levels of a square input.
#[derive(Debug, Clone)]
pub struct Grid {
    levels: Vec<GridLevel>,
}

#[derive(Debug, Clone, Copy)]
struct GridLevel {
    stride: f32,
    columns: usize,
    first: usize,
}

impl Grid {
    /// Creates the grids for an input of `side` x `side` pixels.
    pub fn new(side: usize, strides: &[usize]) -> Self {
        let mut first = 0;
        let level = |stride: &usize| {
            let level = GridLevel { stride: *stride as f32, columns: side / stride, first };
            first += level.columns * level.columns;
            level
        };
        Self { levels: strides.iter().map(level).collect() }
    }

    /// Returns the number of cells of all levels.
    pub fn cells(&self) -> usize {
        self.levels.iter().map(|level| level.columns * level.columns).sum()
    }

    /// Assigns cells to `boxes` and returns them in the order of their indices. A candidate of several boxes is assigned to
    /// the one that its square overlaps most.
    pub fn positives(&self, boxes: &[GroundTruthBox]) -> Vec<Positive> {
        let mut best: BTreeMap<usize, (f32, Positive)> = BTreeMap::new();
        for ground_truth in boxes {
            let candidates: Vec<Candidate> =
                self.levels.iter().flat_map(|level| level.nearest(ground_truth)).collect();
            let enough = mean_and_deviation(&candidates);
            for Candidate { overlap, positive, inside, .. } in candidates {
                let taken = best.get(&positive.cell).is_some_and(|(other, _)| *other >= overlap);
                if overlap >= enough && inside && !taken {
                    best.insert(positive.cell, (overlap, positive));
                }
            }
        }
        best.into_values().map(|(_, positive)| positive).collect()
    }
}

/// A candidate cell of a box.
struct Candidate {
    /// Squared distance between the centres of cell and box.
    far: f32,
    /// IoU of the cell's square and the box.
    overlap: f32,
    inside: bool,
    positive: Positive,
}

impl GridLevel {
    /// Returns the [`NEAREST`] cells of this level.
    fn nearest(self, ground_truth: &GroundTruthBox) -> Vec<Candidate> {
        let reach = NEAREST as f32 / 2.0 + 1.0;
        let [x0, y0, x1, y1] = ground_truth.corners;
        // The window contains the nearest cells: none further away can be among them.
        let window = |low: f32, high: f32| {
            let middle = (low + high) / (2.0 * self.stride);
            let last = self.columns.saturating_sub(1) as f32;
            let middle = middle.clamp(0.0, last);
            let (from, to) = ((middle - reach).max(0.0) as usize, (middle + reach).min(last) as usize);
            from..=to.min(self.columns.saturating_sub(1))
        };
        let (columns, rows) = (window(x0, x1), window(y0, y1));
        let cells = rows.flat_map(|row| columns.clone().map(move |column| (row, column)));
        let mut candidates: Vec<Candidate> =
            cells.map(|(row, column)| self.candidate(row, column, ground_truth)).collect();
        candidates.sort_by(|a, b| a.far.total_cmp(&b.far).then(a.positive.cell.cmp(&b.positive.cell)));
        candidates.truncate(NEAREST);
        candidates
    }

    fn candidate(self, row: usize, column: usize, ground_truth: &GroundTruthBox) -> Candidate {
        let [x0, y0, x1, y1] = ground_truth.corners;
        let (x, y) = ((column as f32 + 0.5) * self.stride, (row as f32 + 0.5) * self.stride);
        let half = SQUARE * self.stride / 2.0;
        let sides = [x - x0, y - y0, x1 - x, y1 - y];
        let (far_x, far_y) = (x - (x0 + x1) / 2.0, y - (y0 + y1) / 2.0);
        Candidate {
            far: far_x * far_x + far_y * far_y,
            overlap: iou([x - half, y - half, x + half, y + half], ground_truth.corners),
            inside: sides.iter().all(|side| *side > INSIDE),
            positive: Positive {
                cell: self.first + row * self.columns + column,
                class: ground_truth.class,
                distances: sides.map(|side| side / self.stride),
            },
        }
    }
}

/// Returns mean plus standard deviation of the overlaps, the threshold of a cell.
fn mean_and_deviation(candidates: &[Candidate]) -> f32 {
    let count = candidates.len().max(1) as f32;
    let mean = candidates.iter().map(|candidate| candidate.overlap).sum::<f32>() / count;
    let squares = candidates.iter().map(|candidate| (candidate.overlap - mean).powi(2)).sum::<f32>();
    mean + (squares / (count - 1.0).max(1.0)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Grid {
        Grid::new(416, &[8, 16, 32])
    }

    #[test]
    fn a_box_is_assigned_to_cells_of_its_size_within_it() {
        for (side, expected_level) in [(60.0, 0), (130.0, 1), (260.0, 2)] {
            let corners = [100.0, 80.0, 100.0 + side, 80.0 + side];
            let positives = grid().positives(&[GroundTruthBox { class: 3, corners }]);
            assert!(!positives.is_empty() && positives.len() <= 3 * NEAREST);
            let first = [0, 2704, 3380, 3549];
            let at_level = positives
                .iter()
                .filter(|positive| {
                    (first[expected_level]..first[expected_level + 1]).contains(&positive.cell)
                })
                .count();
            assert!(2 * at_level > positives.len(), "{side}: {at_level} of {}", positives.len());
            assert!(positives.iter().all(|positive| positive.class == 3));
            assert!(positives.iter().all(|positive| positive.distances.iter().all(|side| *side > 0.0)));
        }
    }

    #[test]
    fn distances_lead_back_to_the_box() {
        let corners = [100.0, 80.0, 230.0, 190.0];
        for Positive { cell, distances: [left, top, right, bottom], .. } in
            grid().positives(&[GroundTruthBox { class: 0, corners }])
        {
            let (stride, columns, first) = match cell {
                0..2704 => (8.0, 52, 0),
                2704..3380 => (16.0, 26, 2704),
                _ => (32.0, 13, 3380),
            };
            let x = ((cell - first) % columns) as f32 * stride + stride / 2.0;
            let y = ((cell - first) / columns) as f32 * stride + stride / 2.0;
            let decoded = [x - left * stride, y - top * stride, x + right * stride, y + bottom * stride];
            assert!(decoded.iter().zip(corners).all(|(a, b)| (a - b).abs() < 1e-3), "{decoded:?}");
        }
    }

    #[test]
    fn a_cell_takes_the_box_that_it_overlaps_most() {
        let small = GroundTruthBox { class: 0, corners: [170.0, 170.0, 240.0, 240.0] };
        let large = GroundTruthBox { class: 1, corners: [100.0, 100.0, 310.0, 310.0] };
        let alone = grid().positives(&[small]).len();
        let both = grid().positives(&[large, small]);
        assert_eq!(both.iter().filter(|positive| positive.class == 0).count(), alone);
        let mut cells: Vec<usize> = both.iter().map(|positive| positive.cell).collect();
        cells.dedup();
        assert_eq!(cells.len(), both.len());
        assert!(both.iter().any(|positive| positive.class == 1));
    }

    #[test]
    fn boxes_outside_have_no_cells() {
        assert!(grid().positives(&[]).is_empty());
        assert!(
            grid()
                .positives(&[GroundTruthBox { class: 0, corners: [900.0, 900.0, 950.0, 980.0] }])
                .is_empty()
        );
        assert_eq!(grid().cells(), 3549);
    }
}
