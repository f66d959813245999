//! The kernel for any sample type and any strides. Plain Rust; the reference of the packed kernels' tests.

use crate::preprocess::band::Row;
use crate::preprocess::plan::Tap;
use crate::preprocess::sample::Written;

/// An image sample as a level, 0..=255.
pub(super) trait Level: Copy + Sync {
    /// Returns the level: `u16` divided by 257, floats times 255.
    fn level(self) -> f32;
}

impl Level for u8 {
    fn level(self) -> f32 {
        f32::from(self)
    }
}

impl Level for u16 {
    fn level(self) -> f32 {
        f32::from(self) * (1.0 / 257.0)
    }
}

impl Level for f32 {
    fn level(self) -> f32 {
        self * 255.0
    }
}

/// Conversion of the levels of a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Finish {
    /// Offsets in samples of the image's channels, in the order of the input's.
    pub(super) channels: [usize; 3],
    /// Whether the three channels (red, green, blue) are combined to luminance.
    pub(super) luminance: bool,
    /// The value is `level * scale + bias`, per channel of the input.
    pub(super) scale: [f32; 3],
    pub(super) bias: [f32; 3],
}

/// Weights of red, green and blue in the luminance by ITU-R BT.601.
pub(crate) const LUMINANCE: [f32; 3] = [0.299, 0.587, 0.114];

/// Blends row `tap` of an image with `strides` (row, pixel) into `row`.
pub(super) fn blend_row<S: Level, W: Written>(
    samples: &[S],
    strides: [usize; 2],
    tap: Tap,
    columns: &[Tap],
    finish: &Finish,
    row: &mut Row<'_, W>,
) {
    let upper = samples.get(tap.first as usize * strides[0]..).unwrap_or_default();
    let lower = samples.get(tap.second as usize * strides[0]..).unwrap_or_default();
    let blend = |column: &Tap, channel: usize| {
        let (first, second) = (column.first as usize * strides[1], column.second as usize * strides[1]);
        let mix = |from: f32, to: f32, weight: f32| from + (to - from) * weight;
        let upper = mix(upper[first + channel].level(), upper[second + channel].level(), column.weight);
        let lower = mix(lower[first + channel].level(), lower[second + channel].level(), column.weight);
        mix(upper, lower, tap.weight)
    };
    let Finish { channels, scale, bias, .. } = *finish;
    let Row { planes, interleaved, channels: count } = row;
    if finish.luminance {
        for (value, column) in planes[0].iter_mut().zip(columns) {
            let weigh = |index: usize| LUMINANCE[index] * blend(column, channels[index]);
            *value = W::from_value((weigh(0) + weigh(1) + weigh(2)) * scale[0] + bias[0]);
        }
    } else if *interleaved {
        for (pixel, column) in planes[0].as_chunks_mut::<3>().0.iter_mut().zip(columns) {
            *pixel = std::array::from_fn(|c| W::from_value(blend(column, channels[c]) * scale[c] + bias[c]));
        }
    } else {
        for (c, plane) in planes.iter_mut().enumerate().take(*count) {
            for (value, column) in plane.iter_mut().zip(columns) {
                *value = W::from_value(blend(column, channels[c]) * scale[c] + bias[c]);
            }
        }
    }
}
