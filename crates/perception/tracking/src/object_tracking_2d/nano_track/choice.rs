//! Selection of the object's position from the network's outputs.

use std::f32::consts::PI;

use opendr_engine::{Error, Result};

use super::params::NanoTrackParams;

/// Number of positions along each axis.
pub const CELLS: usize = 16;
/// Distance between positions, in pixels of the crop.
const STRIDE: f32 = 16.0;

/// Position and size of the object, in pixels of the crop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// Offset of its centre from that of the crop.
    pub offset: [f32; 2],
    /// Width and height.
    pub size: [f32; 2],
    /// Score, 0..=1.
    pub score: f32,
    /// Weight of the new size.
    pub rate: f32,
}

/// The window over the positions: highest in the middle.
pub struct Choice {
    window: [f32; CELLS],
}

impl Default for Choice {
    /// Returns Hann's window.
    fn default() -> Self {
        let level = |at: usize| 0.5 - 0.5 * (2.0 * PI * at as f32 / (CELLS - 1) as f32).cos();
        Self { window: std::array::from_fn(level) }
    }
}

/// Returns the ratio or its inverse, whichever is larger.
fn change(ratio: f32) -> f32 {
    ratio.max(1.0 / ratio)
}

/// Returns the side of the square with the area of a box with its context.
fn extent([width, height]: [f32; 2]) -> f32 {
    let pad = (width + height) / 2.0;
    ((width + pad) * (height + pad)).sqrt()
}

impl Choice {
    /// Returns the position with the highest rank, from the logits `[2, CELLS, CELLS]` of background and object, the
    /// distances `[4, CELLS, CELLS]` to the sides of the box, and the size before. `None` when no position is finite.
    ///
    /// # Errors
    /// `Format` when the number of values differs.
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
                "the network has {} scores and {} distances for {PLACES} positions; load another model",
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

    /// Returns outputs with an object of 40 by 80 pixels at each of the given positions.
    fn outputs(places: &[usize]) -> (Vec<f32>, Vec<f32>) {
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

    fn best(outputs: &(Vec<f32>, Vec<f32>)) -> Option<Found> {
        let params = NanoTrackParams::default();
        Choice::default().best(&outputs.0, &outputs.1, [40.0, 80.0], &params).unwrap()
    }

    #[test]
    fn a_place_becomes_an_offset() {
        let found = best(&outputs(&[10 * CELLS + 6])).unwrap();
        assert_eq!((found.offset, found.size), ([-32.0, 32.0], [40.0, 80.0]));
        assert!(found.score > 0.999 && (found.rate - 0.348).abs() < 1e-3);
    }

    #[test]
    fn the_nearer_position_and_the_previous_size_win() {
        let found = best(&outputs(&[0, 9 * CELLS + 9])).unwrap();
        assert_eq!(found.offset, [16.0, 16.0]);
        let mut two = outputs(&[7 * CELLS + 8, 9 * CELLS + 8]);
        two.1[7 * CELLS + 8] = 300.0;
        assert_eq!(best(&two).unwrap().offset, [0.0, 16.0]);
    }

    #[test]
    fn invalid_outputs_have_no_position() {
        let mut all = outputs(&[]);
        all.1.fill(f32::NAN);
        assert_eq!(best(&all), None);
        let (classes, sides) = outputs(&[5]);
        let few = Choice::default().best(&classes[1..], &sides, [1.0, 1.0], &NanoTrackParams::default());
        assert!(few.is_err());
    }
}
