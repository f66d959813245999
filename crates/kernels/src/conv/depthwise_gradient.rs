//! Gradients of the weights of depthwise convolutions.

use std::ops::Range;

use super::geometry::Window;
use super::training::TrainingConvolution;
use crate::aligned::{Output, SUMS, with_buffer};
use crate::compute::Compute;
use crate::isa::for_every_isa;
use crate::lanes::{Lanes, MAX_WIDTH};

/// Numbers of input and output that the sums of a block read: they stay in the L2 cache.
const BLOCK: usize = 1 << 17;

/// Computes the gradient of the weights; the lengths have been checked.
pub(super) fn depthwise_weight_gradient(
    conv: &TrainingConvolution,
    compute: &Compute,
    x: &[f32],
    dy: &[f32],
    dw: &mut [f32],
) {
    let sums = &Sums::new(conv, x, dy);
    let (channels, taps) = (conv.channels, conv.taps());
    let padded = channels.next_multiple_of(MAX_WIDTH);
    let blocks = padded / MAX_WIDTH;
    let at_once = blocks.div_ceil(2 * compute.pool().threads()).min(4);
    with_buffer(&SUMS, taps * padded, |all| {
        all.fill(0.0);
        let to = Output(all.as_mut_ptr());
        compute.pool().run(blocks.div_ceil(at_once), |piece| {
            let first = piece * at_once * MAX_WIDTH;
            let range = first..((piece + 1) * at_once * MAX_WIDTH).min(padded);
            // SAFETY: lengths have been checked; the pieces write disjoint columns.
            unsafe { dispatch_depthwise(compute.isa(), sums, range, to.at(0), padded) };
        });
        for (channel, dw) in dw.chunks_mut(taps).enumerate() {
            dw.iter_mut().enumerate().for_each(|(tap, dw)| *dw = all[tap * padded + channel]);
        }
    });
}

/// Input and gradient of the output, whose products are summed over the pixels.
struct Sums<'a> {
    conv: &'a TrainingConvolution,
    x: *const f32,
    dy: *const f32,
    /// Columns of the output whose tap lies within the input, for each column of taps.
    columns: Vec<[usize; 2]>,
}

// SAFETY: what the pointers refer to is only read.
unsafe impl Sync for Sums<'_> {}

/// Pixels of a row of the output whose tap lies within the input.
struct Run {
    x: *const f32,
    dy: *const f32,
    count: usize,
}

impl<'a> Sums<'a> {
    fn new(conv: &'a TrainingConvolution, x: &'a [f32], dy: &'a [f32]) -> Self {
        let Window { kernel, strides, dilations, pads, input, output } = conv.window;
        let columns = (0..kernel[1]).map(|tap| {
            let at = tap * dilations[1];
            let first = pads[1].saturating_sub(at).div_ceil(strides[1]).min(output[1]);
            let end = (input[1] + pads[1]).checked_sub(at + 1).map_or(0, |last| last / strides[1] + 1);
            [first, end.min(output[1]).max(first)]
        });
        Self { conv, x: x.as_ptr(), dy: dy.as_ptr(), columns: columns.collect() }
    }

    /// Returns the number of rows of the output, of all images.
    fn rows(&self) -> usize {
        self.conv.batch * self.conv.window.output[0]
    }

    /// Returns the number of rows whose pixels fill a block, where each pixel has so many numbers.
    fn rows_of_block(&self, numbers: usize) -> usize {
        (BLOCK / (self.conv.window.output[1] * numbers).max(1)).clamp(1, self.rows())
    }

    /// Returns the pixels of a row of the output whose tap lies within the input.
    #[inline(always)]
    unsafe fn run(&self, row: usize, tap: usize) -> Option<Run> {
        let Window { kernel, strides, dilations, pads, input, output } = self.conv.window;
        // SAFETY: pixels lie within the tensors.
        unsafe {
            let (image, line) = (row / output[0], row % output[0]);
            let (ky, kx) = (tap / kernel[1], tap % kernel[1]);
            let [first, end] = self.columns[kx];
            let at = (line * strides[0] + ky * dilations[0]).checked_sub(pads[0]).filter(|&at| at < input[0]);
            let line = at.filter(|_| first < end)?;
            let column = first * strides[1] + kx * dilations[1] - pads[1];
            let pixel = (image * input[0] + line) * input[1] + column;
            let run = Run {
                x: self.x.add(pixel * self.conv.channels),
                dy: self.dy.add((row * output[1] + first) * self.conv.outputs),
                count: end - first,
            };
            Some(run)
        }
    }
}

for_every_isa!(fn dispatch_depthwise = depthwise_sums(sums: &Sums<'_>, channels: Range<usize>, to: *mut f32, padded: usize));

/// # Safety
/// The tensors have the sizes of the convolution; nothing else uses the columns of these channels.
#[inline(always)]
unsafe fn depthwise_sums<V: Lanes>(sums: &Sums<'_>, channels: Range<usize>, to: *mut f32, padded: usize) {
    let at_once = sums.rows_of_block(8 * channels.len());
    for first in (0..sums.rows()).step_by(at_once) {
        let rows = first..(first + at_once).min(sums.rows());
        for tap in 0..sums.conv.taps() {
            let mut channel = channels.start;
            while channel < channels.end {
                // SAFETY: the columns are filled up to whole registers.
                unsafe {
                    let to = to.add(tap * padded + channel);
                    if channel + 4 * V::WIDTH <= channels.end.min(sums.conv.channels) {
                        channel_sums::<V, 4>(sums, &rows, tap, channel, to);
                        channel += 4 * V::WIDTH;
                    } else {
                        channel_sums::<V, 1>(sums, &rows, tap, channel, to);
                        channel += V::WIDTH;
                    }
                }
            }
        }
    }
}

#[inline(always)]
unsafe fn channel_sums<V: Lanes, const N: usize>(
    sums: &Sums<'_>,
    rows: &Range<usize>,
    tap: usize,
    channel: usize,
    to: *mut f32,
) {
    let channels = sums.conv.channels;
    let count = channels.saturating_sub(channel).min(V::WIDTH);
    if count == 0 {
        return;
    }
    let x_step = sums.conv.window.strides[1] * channels;
    // SAFETY: the channels lie within the pixels.
    unsafe {
        let load = |from: *const f32| {
            if N > 1 || count == V::WIDTH { V::load(from) } else { V::load_some(from, count) }
        };
        let mut all = [V::splat(0.0); N];
        for (n, sum) in all.iter_mut().enumerate() {
            *sum = V::load(to.add(n * V::WIDTH));
        }
        for row in rows.clone() {
            let Some(Run { x, dy, count }) = sums.run(row, tap) else { continue };
            let (mut x, mut dy) = (x.add(channel), dy.add(channel));
            for _ in 0..count {
                for (n, sum) in all.iter_mut().enumerate() {
                    *sum = load(x.add(n * V::WIDTH)).mul_add(load(dy.add(n * V::WIDTH)), *sum);
                }
                x = x.wrapping_add(x_step);
                dy = dy.wrapping_add(channels);
            }
        }
        for (n, sum) in all.iter().enumerate() {
            sum.store(to.add(n * V::WIDTH));
        }
    }
}
