//! Features of the object, and their comparison with views.

use super::layout::{CELLS, FEATURES, PLACES, TEMPLATE, VpitLayout};

/// Similarity of template and view at every position, row by row.
pub(super) type Comparison = [f32; PLACES * PLACES];

/// Features of an object in the centre of a view.
#[derive(Default)]
pub(super) struct Template {
    cells: Vec<[usize; 2]>,
    /// `FEATURES` values per cell.
    features: Vec<f32>,
}

/// Index of the first cell of a template in its view.
const FIRST: usize = (CELLS - TEMPLATE) / 2;

impl Template {
    /// Stores the features `[FEATURES, CELLS, CELLS]` of an object of this length and width.
    pub fn take(&mut self, layout: &VpitLayout, size: [f64; 2], context: f64, features: &[f32]) {
        self.cells.clear();
        self.cells.extend(layout.covered(size, context));
        self.features.clear();
        self.features.resize(self.cells.len() * FEATURES, 0.0);
        self.merge(features, 1.0);
    }

    /// Replaces `share` of the stored features by those of another view.
    pub fn merge(&mut self, features: &[f32], share: f32) {
        for ([row, column], own) in self.cells.iter().zip(self.features.chunks_exact_mut(FEATURES)) {
            let at = (FIRST + row) * CELLS + FIRST + column;
            for (own, plane) in own.iter_mut().zip(features.chunks_exact(CELLS * CELLS)) {
                *own += share * (plane[at] - *own);
            }
        }
    }

    /// Computes the mean product of the stored features and those of a view, at every position.
    pub fn compare(&self, features: &[f32], comparison: &mut Comparison) {
        comparison.fill(0.0);
        for ([row, column], own) in self.cells.iter().zip(self.features.chunks_exact(FEATURES)) {
            for (weight, plane) in own.iter().zip(features.chunks_exact(CELLS * CELLS)) {
                for (place, sums) in comparison.chunks_exact_mut(PLACES).enumerate() {
                    let begin = (place + row) * CELLS + column;
                    let seen = &plane[begin..begin + PLACES];
                    sums.iter_mut().zip(seen).for_each(|(sum, seen)| *sum += weight * seen);
                }
            }
        }
        let cells = self.cells.len().max(1) as f32;
        comparison.iter_mut().for_each(|sum| *sum /= cells);
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::Random;

    use super::*;

    const LAYOUT: VpitLayout = VpitLayout { pillar: 0.2, heights: [-0.5, 3.0], scale: 1.0, bias: 0.0 };

    #[test]
    fn a_shift_is_found() {
        let mut random = Random::new(5);
        let features: Vec<f32> = (0..FEATURES * CELLS * CELLS).map(|_| random.normal() as f32).collect();
        let mut template = Template::default();
        template.take(&LAYOUT, [3.0, 1.5], 0.25, &features);
        // All features 3 cells ahead and 2 to the right.
        let mut moved = vec![0.0; features.len()];
        for (plane, before) in moved.chunks_exact_mut(CELLS * CELLS).zip(features.chunks_exact(CELLS * CELLS))
        {
            for row in 0..CELLS - 2 {
                plane[row * CELLS + 3..][..CELLS - 3]
                    .copy_from_slice(&before[(row + 2) * CELLS..][..CELLS - 3]);
            }
        }
        let mut comparison = [0.0; PLACES * PLACES];
        template.compare(&moved, &mut comparison);
        let best = (0..comparison.len()).max_by(|a, b| comparison[*a].total_cmp(&comparison[*b])).unwrap();
        let middle = PLACES / 2;
        assert_eq!([best / PLACES, best % PLACES], [middle - 2, middle + 3]);
        template.merge(&moved, 1.0);
        template.compare(&moved, &mut comparison);
        let best = (0..comparison.len()).max_by(|a, b| comparison[*a].total_cmp(&comparison[*b])).unwrap();
        assert_eq!([best / PLACES, best % PLACES], [middle; 2]);
    }
}
