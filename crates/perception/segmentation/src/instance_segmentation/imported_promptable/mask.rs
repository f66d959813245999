//! Masks in pixels of the image, from logits of lower resolution.
//!
//! Segment Anything enlarges the logits bilinearly to the size of its input, cuts off the padding, and scales the rest bilinearly to the
//! size of the image. Both steps are linear and work along each axis alone: a pixel is a sum of up to four logits along each axis.

use opendr_engine::Result;
use opendr_engine::target::Segment;
use opendr_perception_common::mask_runs::MaskRuns;

/// The logits that a pixel consists of along an axis, and their weights, whose sum is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Taps {
    at: [usize; 4],
    weights: [f32; 4],
}

/// Sizes along an axis: of the image, of the image in the encoder's input, of this input, and of the logits.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sides {
    pub(super) image: usize,
    pub(super) placed: usize,
    pub(super) input: usize,
    pub(super) logits: usize,
}

/// Enlarges logits to masks, with reused memory.
#[derive(Default)]
pub(super) struct Upsampling {
    columns: Vec<Taps>,
    rows: Vec<Taps>,
    /// The logits column by column, and those of a column of the image.
    turned: Vec<f32>,
    column: Vec<f32>,
}

/// A mask with pixels.
pub(super) struct Mask {
    pub(super) segment: Segment,
    /// Left, top, right and bottom edge of the pixels.
    pub(super) corners: [f32; 4],
}

impl Upsampling {
    /// Returns the pixels with logits above `threshold`; `None` if there are none. `logits` are row by row; no side is 0.
    ///
    /// # Errors
    /// `Format` when the image is too large for run lengths.
    pub(super) fn mask(
        &mut self,
        logits: &[f32],
        [across, down]: [Sides; 2],
        threshold: f32,
    ) -> Result<Option<Mask>> {
        let Self { columns, rows, turned, column, .. } = self;
        fill_taps(columns, across);
        fill_taps(rows, down);
        turned.clear();
        turned.extend((0..across.logits).flat_map(|x| logits.iter().skip(x).step_by(across.logits)));
        let mut runs = MaskRuns::default();
        let [mut left, mut top, mut right, mut bottom] = [usize::MAX, usize::MAX, 0, 0];
        for (x, taps) in columns.iter().enumerate() {
            let parts = taps.at.map(|at| &turned[at * down.logits..(at + 1) * down.logits]);
            column.clear();
            column.extend((0..down.logits).map(|row| {
                parts.iter().zip(taps.weights).map(|(part, weight)| part[row] * weight).sum::<f32>()
            }));
            // What is between logits is not above all of them.
            if column.iter().all(|logit| *logit <= threshold) {
                continue;
            }
            for (y, taps) in rows.iter().enumerate() {
                let logit: f32 =
                    taps.at.iter().zip(taps.weights).map(|(at, weight)| column[*at] * weight).sum();
                if logit > threshold {
                    runs.set(x * down.image + y);
                    (left, right) = (left.min(x), x);
                    (top, bottom) = (top.min(y), bottom.max(y));
                }
            }
        }
        if left == usize::MAX {
            return Ok(None);
        }
        let segment = runs.finish([across.image, down.image])?;
        let corners = [left, top, right + 1, bottom + 1].map(|edge| edge as f32);
        Ok(Some(Mask { segment, corners }))
    }
}

fn fill_taps(taps: &mut Vec<Taps>, sides: Sides) {
    taps.clear();
    taps.extend((0..sides.image).map(|pixel| {
        let (first, second, share) = between(pixel, sides.image, sides.placed);
        let [(a, b, low), (c, d, high)] = [first, second].map(|at| between(at, sides.input, sides.logits));
        let weights = [(1.0 - share) * (1.0 - low), (1.0 - share) * low, share * (1.0 - high), share * high];
        Taps { at: [a, b, c, d], weights }
    }));
}

/// Returns the two samples of `from` between which the centre of sample `at` of `to` lies, and the share of the second.
fn between(at: usize, to: usize, from: usize) -> (usize, usize, f32) {
    let last = from.saturating_sub(1);
    let position = ((at as f32 + 0.5) * (from as f32 / to as f32) - 0.5).clamp(0.0, last as f32);
    let first = position as usize;
    (first, (first + 1).min(last), position - first as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_engine::target::Segmentation;

    fn pixels(mask: &Mask) -> Vec<bool> {
        let Segmentation::Rle(rle) = &mask.segment.segmentation else { panic!("{:?}", mask.segment) };
        rle.mask().unwrap()
    }

    #[test]
    fn padding_is_cut_and_the_rest_fills_the_image() {
        // The image is the upper half of the input; logits rise from left to right.
        let across = Sides { image: 8, placed: 16, input: 16, logits: 4 };
        let down = Sides { image: 4, placed: 8, input: 16, logits: 4 };
        let logits: Vec<f32> = (0..16).map(|at| (at % 4) as f32 - 1.5).collect();
        let mask = Upsampling::default().mask(&logits, [across, down], 0.0).unwrap().unwrap();
        let wanted: Vec<bool> = (0..32).map(|at| at % 8 >= 4).collect();
        assert_eq!((pixels(&mask), mask.segment.area), (wanted, 16.0));
        assert_eq!(mask.corners, [4.0, 0.0, 8.0, 4.0]);
        // The same by rows: the lower half of the logits is padding.
        let logits: Vec<f32> = (0..16).map(|at| 1.5 - (at / 4) as f32).collect();
        let mut upsampling = Upsampling::default();
        let mask = upsampling.mask(&logits, [across, down], 0.0).unwrap().unwrap();
        assert_eq!(mask.corners, [0.0, 0.0, 8.0, 4.0]);
        let mask = upsampling.mask(&logits, [across, down], 1.0).unwrap().unwrap();
        assert_eq!(mask.corners, [0.0, 0.0, 8.0, 2.0]);
        assert!(upsampling.mask(&logits, [across, down], 5.0).unwrap().is_none());
    }

    #[test]
    fn weights_are_shares() {
        for sides in [
            Sides { image: 7, placed: 64, input: 64, logits: 16 },
            Sides { image: 200, placed: 31, input: 64, logits: 16 },
            Sides { image: 3, placed: 1, input: 64, logits: 1 },
            Sides { image: 5, placed: 4, input: 4, logits: 300 },
        ] {
            let mut taps = Vec::new();
            fill_taps(&mut taps, sides);
            assert_eq!(taps.len(), sides.image);
            for Taps { at, weights } in taps {
                assert!(at.iter().all(|at| *at < sides.logits), "{sides:?}");
                assert!(weights.iter().all(|weight| (0.0..=1.0).contains(weight)));
                assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn logits_that_are_no_numbers_are_outside() {
        let side = Sides { image: 4, placed: 4, input: 4, logits: 2 };
        assert!(Upsampling::default().mask(&[f32::NAN; 4], [side; 2], 0.0).unwrap().is_none());
    }
}
