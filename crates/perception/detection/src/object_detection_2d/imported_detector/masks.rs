//! Masks from prototypes and coefficients, as in YOLACT.
//!
//! D. Bolya et al., YOLACT: Real-time Instance Segmentation, ICCV 2019. The logits of a mask are a sum of prototypes, weighted by the
//! coefficients of a detection. They are cut to the part of the prototypes that shows the image, scaled bilinearly to the size of the image, and
//! cut to the box.

use opendr_engine::target::Segment;
use opendr_engine::{Error, Result};
use opendr_inference::TensorView;
use opendr_perception_common::mask_runs::MaskRuns;
use opendr_vision::InputGeometry;

/// Prototypes `[channels, height, width]` of one image.
#[derive(Debug, Clone, Copy)]
pub(super) struct Prototypes<'a> {
    values: &'a [f32],
    channels: usize,
    height: usize,
    width: usize,
}

/// Columns and rows of the prototypes that show the image: left, top, right, bottom.
type Content = [usize; 4];

/// Work memory: the logits of a box at the resolution of the prototypes.
#[derive(Default)]
pub(super) struct MaskScratch {
    logits: Vec<f32>,
}

impl<'a> Prototypes<'a> {
    /// Reads an output `[1, channels, height, width]`.
    ///
    /// # Errors
    /// `Format` for another shape, `InvalidInput` for another type of elements.
    pub(super) fn of(output: &TensorView<'a>) -> Result<Self> {
        let values = output.values::<f32>()?;
        match *output.shape() {
            [1, channels, height, width] if channels * height * width > 0 => {
                Ok(Self { values, channels, height, width })
            }
            _ => Err(Error::format(format!("an output {output:?} is no prototypes of masks"))),
        }
    }

    /// Returns the number of prototypes.
    pub(super) fn channels(&self) -> usize {
        self.channels
    }

    /// Returns the part that shows an image of `image` pixels, of a network with an input of `input` pixels.
    pub(super) fn content(&self, geometry: &InputGeometry, image: [usize; 2], input: [usize; 2]) -> Content {
        let [left, top] = geometry.input_from_image([0.0, 0.0]);
        let [right, bottom] = geometry.input_from_image(image.map(|side| side as f32));
        // Whole columns and rows, of which half a one is image rather than padding.
        let range = |first: f32, end: f32, input: usize, count: usize| {
            let scale = count as f32 / input as f32;
            let first = (first * scale - 0.1).round().max(0.0) as usize;
            let rest = (count as f32 - end * scale + 0.1).round().max(0.0) as usize;
            let end = count.saturating_sub(rest).max(1);
            (first.min(end - 1), end)
        };
        let (left, right) = range(left, right, input[0], self.width);
        let (top, bottom) = range(top, bottom, input[1], self.height);
        [left, top, right, bottom]
    }

    /// Returns the mask of a box with corners in pixels of the image.
    ///
    /// # Errors
    /// `Format` when the image is too large for run lengths.
    pub(super) fn mask(
        &self,
        coefficient: impl Fn(usize) -> f32,
        content: Content,
        corners: [f32; 4],
        image: [usize; 2],
        scratch: &mut MaskScratch,
    ) -> Result<Segment> {
        let [left, top, right, bottom] = content;
        let columns = Axis::new(corners[0], corners[2], image[0], right - left);
        let rows = Axis::new(corners[1], corners[3], image[1], bottom - top);
        // The logits between which pixels of the box are interpolated.
        let ([first_column, last_column], [first_row, last_row]) = (columns.span(), rows.span());
        let across = last_column - first_column + 1;
        let logits = &mut scratch.logits;
        logits.clear();
        logits.resize(across * (last_row - first_row + 1), 0.0);
        for channel in 0..self.channels {
            let weight = coefficient(channel);
            for (row, logits) in (first_row..).zip(logits.chunks_exact_mut(across)) {
                let from = (channel * self.height + top + row) * self.width + left + first_column;
                let prototype = &self.values[from..from + across];
                logits.iter_mut().zip(prototype).for_each(|(logit, value)| *logit += weight * value);
            }
        }
        let mut runs = MaskRuns::default();
        for x in columns.first..columns.end {
            let (at, share) = columns.position(x);
            let next = (at + 1).min(columns.samples - 1);
            for y in rows.first..rows.end {
                let (row, below_share) = rows.position(y);
                let below = (row + 1).min(rows.samples - 1);
                let logit =
                    |row: usize, column: usize| logits[(row - first_row) * across + column - first_column];
                let along = |row: usize| logit(row, at) * (1.0 - share) + logit(row, next) * share;
                if along(row) * (1.0 - below_share) + along(below) * below_share > 0.0 {
                    runs.set(x * image[1] + y);
                }
            }
        }
        runs.finish(image)
    }
}

/// The pixels of a box along one axis, and the samples between which they lie.
struct Axis {
    first: usize,
    end: usize,
    scale: f32,
    samples: usize,
}

impl Axis {
    fn new(first: f32, end: f32, pixels: usize, samples: usize) -> Self {
        // A pixel belongs to the box where its index does. Conversions of NaN and of numbers outside the image saturate.
        let clipped = |edge: f32| (edge.ceil().max(0.0) as usize).min(pixels);
        let (first, end) = (clipped(first), clipped(end));
        Self { first, end: end.max(first), scale: samples as f32 / pixels.max(1) as f32, samples }
    }

    /// Returns the sample before a pixel's centre, and the share of the next one.
    fn position(&self, pixel: usize) -> (usize, f32) {
        let at = ((pixel as f32 + 0.5) * self.scale - 0.5).max(0.0);
        let index = (at as usize).min(self.samples - 1);
        (index, at - index as f32)
    }

    /// Returns the first and the last sample of the pixels.
    fn span(&self) -> [usize; 2] {
        let last = self.position(self.end.saturating_sub(1).max(self.first)).0;
        [self.position(self.first).0, (last + 1).min(self.samples - 1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_engine::target::Segmentation;

    /// Two prototypes of 4x4: one rises from left to right, one is 1 everywhere.
    fn prototypes() -> [f32; 32] {
        std::array::from_fn(|at| if at < 16 { (at % 4) as f32 } else { 1.0 })
    }

    fn mask(corners: [f32; 4], content: Content, image: [usize; 2]) -> (Vec<bool>, f32) {
        let values = prototypes();
        let prototypes = Prototypes { values: &values, channels: 2, height: 4, width: 4 };
        let coefficient = |channel| [1.0, -1.5][channel];
        let mut scratch = MaskScratch::default();
        let segment = prototypes.mask(coefficient, content, corners, image, &mut scratch).unwrap();
        let Segmentation::Rle(rle) = segment.segmentation else { panic!("{segment:?}") };
        assert_eq!(rle.size(), [image[1] as u32, image[0] as u32]);
        (rle.mask().unwrap(), segment.area)
    }

    #[test]
    fn pixels_right_of_the_edge_and_within_the_box_are_set() {
        // Logits are x - 1.5 in prototype pixels: positive right of the middle.
        let (found, area) = mask([0.0, 2.0, 6.4, 8.0], [0, 0, 4, 4], [8, 8]);
        for (at, is_set) in found.into_iter().enumerate() {
            let (x, y) = (at % 8, at / 8);
            assert_eq!(is_set, (4..7).contains(&x) && y >= 2, "{x}, {y}");
        }
        assert_eq!(area, 18.0);
    }

    #[test]
    fn padding_is_cut_off() {
        // Of the prototypes only the columns 2 and 3 show the image: all logits are positive.
        let (found, area) = mask([0.0, 0.0, 8.0, 8.0], [2, 0, 4, 4], [8, 8]);
        assert!(found.into_iter().all(|is_set| is_set));
        assert_eq!(area, 64.0);
    }

    #[test]
    fn boxes_outside_of_the_image_have_no_pixels() {
        for corners in
            [[f32::NAN; 4], [20.0, 20.0, 30.0, 30.0], [5.0, 5.0, 2.0, 2.0], [-9.0, -9.0, -1.0, -1.0]]
        {
            assert_eq!(mask(corners, [0, 0, 4, 4], [8, 8]).1, 0.0);
        }
    }
}
