//! Which of the places that the network proposes is the object.

use std::f32::consts::PI;

use opendr_engine::{Error, Result};

use super::NanoTrackParams;

/// Places each way.
pub const CELLS: usize = 16;
/// How far they are apart, pixels of the crop.
const STRIDE: f32 = 16.0;

/// Where the object is, in pixels of the crop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// Of its middle from that of the crop.
    pub offset: [f32; 2],
    /// Width and height.
    pub size: [f32; 2],
    /// How sure it is, 0..=1.
    pub score: f32,
    /// How much of its size counts.
    pub rate: f32,
}

/// The window over the places: high in the middle.
pub struct Choice {
    window: [f32; CELLS],
}

impl Default for Choice {
    /// Hann's window.
    fn default() -> Self {
        let level = |at: usize| 0.5 - 0.5 * (2.0 * PI * at as f32 / (CELLS - 1) as f32).cos();
        Self { window: std::array::from_fn(level) }
    }
}

/// How much larger the larger is.
fn change(ratio: f32) -> f32 {
    ratio.max(1.0 / ratio)
}

/// The side of a square as large as what is seen of a box.
fn extent([width, height]: [f32; 2]) -> f32 {
    let pad = (width + height) / 2.0;
    ((width + pad) * (height + pad)).sqrt()
}

impl Choice {
    /// The best place, given the logits `[2, CELLS, CELLS]` of what is not and what is the object, the distances `[4, CELLS, CELLS]` to
    /// the sides of its box, and its size before. None where no place has numbers.
    ///
    /// # Errors
    /// `Format` when there are not as many numbers.
    pub fn best(
        &self,
        classes: &[f32],
        sides: &[f32],
        before: [f32; 2],
        params: &NanoTrackParams,
    ) -> Result<Option<Found>> {
        const PLACES: usize = CELLS * CELLS;
        if classes.len() != 2 * PLACES || sides.len() != 4 * PLACES {
            return Err(Error::format(format!(
                "{} scores and {} distances of {PLACES} places",
                classes.len(),
                sides.len()
            )));
        }
        let mut best: Option<(f32, Found)> = None;
        for place in 0..PLACES {
            let (column, row) = (place % CELLS, place / CELLS);
            let score = 1.0 / (1.0 + (classes[place] - classes[PLACES + place]).exp());
            let [left, top, right, bottom] = [0, 1, 2, 3].map(|side| sides[side * PLACES + place]);
            let size = [left + right, top + bottom];
            let is_box = size[0] > 0.0 && size[1] > 0.0 && size.iter().all(|side| side.is_finite());
            if !is_box || !score.is_finite() {
                continue;
            }
            let grown = change(extent(size) / extent(before));
            let turned = change((before[0] / before[1]) / (size[0] / size[1]));
            let penalty = (-(grown * turned - 1.0) * params.penalty).exp();
            let near = self.window[column] * self.window[row];
            let rank = penalty * score * (1.0 - params.window_influence) + near * params.window_influence;
            if best.is_some_and(|(other, _)| other >= rank) {
                continue;
            }
            let middle = |at: usize, less: f32, more: f32| {
                (at as f32 - CELLS as f32 / 2.0) * STRIDE + (more - less) / 2.0
            };
            let offset = [middle(column, left, right), middle(row, top, bottom)];
            best = Some((rank, Found { offset, size, score, rate: penalty * score * params.size_rate }));
        }
        Ok(best.map(|(_, found)| found))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACES: usize = CELLS * CELLS;

    /// Nothing anywhere but an object of 40 by 80 pixels at each of these places.
    fn answers(places: &[usize]) -> (Vec<f32>, Vec<f32>) {
        let (mut classes, mut sides) = (vec![0.0; 2 * PLACES], vec![0.0; 4 * PLACES]);
        classes[..PLACES].fill(8.0);
        for side in 0..4 {
            sides[side * PLACES..][..PLACES].fill([20.0, 40.0, 20.0, 40.0][side]);
        }
        for place in places {
            (classes[*place], classes[PLACES + place]) = (0.0, 8.0);
        }
        (classes, sides)
    }

    fn best(answers: &(Vec<f32>, Vec<f32>)) -> Option<Found> {
        let params = NanoTrackParams::default();
        Choice::default().best(&answers.0, &answers.1, [40.0, 80.0], &params).unwrap()
    }

    #[test]
    fn a_place_becomes_an_offset() {
        let found = best(&answers(&[10 * CELLS + 6])).unwrap();
        assert_eq!((found.offset, found.size), ([-32.0, 32.0], [40.0, 80.0]));
        assert!(found.score > 0.999 && (found.rate - 0.348).abs() < 1e-3);
    }

    #[test]
    fn of_two_the_nearer_is_it_and_of_two_sizes_the_one_before() {
        let found = best(&answers(&[0, 9 * CELLS + 9])).unwrap();
        assert_eq!(found.offset, [16.0, 16.0]);
        let mut two = answers(&[7 * CELLS + 8, 9 * CELLS + 8]);
        two.1[7 * CELLS + 8] = 300.0;
        assert_eq!(best(&two).unwrap().offset, [0.0, 16.0]);
    }

    #[test]
    fn numbers_that_are_none_are_no_place() {
        let mut all = answers(&[]);
        all.1.fill(f32::NAN);
        assert_eq!(best(&all), None);
        let (classes, sides) = answers(&[5]);
        let few = Choice::default().best(&classes[1..], &sides, [1.0, 1.0], &NanoTrackParams::default());
        assert!(few.is_err());
    }
}
