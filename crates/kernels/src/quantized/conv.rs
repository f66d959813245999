//! Convolutions of bytes: patches of the input by packed weights, a piece of output pixels at a time.

use std::sync::Arc;

use super::dots::Dots;
use super::filters::ByteFilters;
use super::instructions::for_all_instructions;
use super::output::{Bounds, ByteOutput};
use super::tile::{Rows, panel};
use crate::aligned::{LEFT_PANELS, PATCHES, with_buffer};
use crate::compute::Compute;
use crate::conv::Window;
use crate::cost::LayerCost;

/// Number of multiplications from which on several threads are used.
const PARALLEL_FROM: usize = 1 << 18;
/// Bytes of the patches of a piece: they stay in the cache while all weights pass.
const PIECE_BYTES: usize = 48 << 10;
/// Pieces have multiples of this number of pixels: whole tiles.
const STEP: usize = 24;

/// A convolution of bytes of known shapes.
#[derive(Debug, Clone)]
pub struct ByteConvolution {
    /// Weights, bias and scales.
    pub filters: Arc<ByteFilters>,
    /// Geometry.
    pub window: Window,
    /// Number of images.
    pub batch: usize,
    /// Quantisation of the output.
    pub output: ByteOutput,
}

impl ByteConvolution {
    /// Returns the arithmetic and the bytes of the weights.
    pub fn cost(&self) -> LayerCost {
        let Window { kernel, output, .. } = self.window;
        let ByteFilters { outputs, channels, .. } = *self.filters;
        let factors = [self.batch, output[0], output[1], outputs, channels, kernel[0], kernel[1]];
        LayerCost::bytes(&factors).with_weights(self.filters.bytes())
    }

    /// Computes the convolution; signed bytes are given as their bits.
    ///
    /// # Panics
    /// When the slices do not have the stated shapes.
    pub fn run(&self, compute: &Compute, x: &[u8], y: &mut [u8]) {
        self.check(x.len(), y.len());
        self.start(compute, x, y.as_mut_ptr(), Some(&self.output.bounds()));
    }

    /// Computes the sums of the convolution, with the bias, without scales.
    ///
    /// # Panics
    /// When the slices do not have the stated shapes.
    pub fn run_to_sums(&self, compute: &Compute, x: &[u8], y: &mut [i32]) {
        self.check(x.len(), y.len());
        self.start(compute, x, y.as_mut_ptr().cast(), None);
    }

    fn check(&self, x: usize, y: usize) {
        let Window { input, output, kernel, .. } = self.window;
        assert_eq!(self.filters.kernel, kernel, "the filters must have the size of the kernel");
        assert_eq!(x, self.batch * input[0] * input[1] * self.filters.channels, "the size of the input");
        assert_eq!(y, self.batch * output[0] * output[1] * self.filters.outputs, "the size of the output");
    }

    fn start(&self, compute: &Compute, x: &[u8], y: *mut u8, bounds: Option<&Bounds>) {
        let filters = &*self.filters;
        let pixels = self.batch * self.window.output[0] * self.window.output[1];
        if pixels == 0 || filters.outputs == 0 {
            return;
        }
        let (threads, panels) = (compute.pool().threads(), filters.panel_count());
        let most = (PIECE_BYTES / (4 * filters.words).max(1)).clamp(STEP, 10 * STEP);
        let wanted = if threads == 1 { 1 } else { 4 * threads };
        let per_piece = most.min(pixels.div_ceil(wanted)).next_multiple_of(STEP);
        let pieces = pixels.div_ceil(per_piece);
        let shares = if pieces >= threads { 1 } else { panels.min(2 * threads) };
        let is_direct = filters.instructions.is_bytes()
            && self.window.is_pointwise()
            && !filters.input.is_signed
            && filters.channels.is_multiple_of(4);
        let job = Job { conv: self, x, y, bounds, pixels, per_piece, shares, is_direct };
        let work = |index| job.run(index);
        let products = pixels * filters.outputs * filters.words * 4;
        if products < PARALLEL_FROM {
            (0..pieces * shares).for_each(work);
        } else {
            compute.pool().run(pieces * shares, work);
        }
    }
}

struct Job<'a> {
    conv: &'a ByteConvolution,
    x: &'a [u8],
    y: *mut u8,
    bounds: Option<&'a Bounds>,
    pixels: usize,
    per_piece: usize,
    /// Parts of the panels.
    shares: usize,
    /// Whether the rows of the product are the pixels of the input.
    is_direct: bool,
}

// SAFETY: pieces read the input and write different outputs.
unsafe impl Sync for Job<'_> {}

impl Job<'_> {
    /// Computes a piece. Buffers are taken out here: a closure has no instructions beyond those of its function.
    fn run(&self, index: usize) {
        let filters = &*self.conv.filters;
        let first = index / self.shares * self.per_piece;
        let count = self.per_piece.min(self.pixels - first);
        let rows = [first, count];
        if self.is_direct {
            // SAFETY: sizes have been checked; pieces and shares write different outputs.
            return unsafe { dispatch_direct(filters.instructions, self, index, rows) };
        }
        let depth = filters.channels * filters.kernel[0] * filters.kernel[1];
        let stride = depth.next_multiple_of(filters.instructions.taps());
        with_buffer(&PATCHES, (count * stride).div_ceil(4), |buffer| {
            // SAFETY: the buffer has as many bytes; every number of 32 bits is four bytes.
            let patches =
                unsafe { std::slice::from_raw_parts_mut(buffer.as_mut_ptr().cast::<u8>(), count * stride) };
            if filters.instructions.is_bytes() {
                // SAFETY: as above.
                return unsafe { dispatch_bytes(filters.instructions, self, index, rows, patches) };
            }
            with_buffer(&LEFT_PANELS, (count * stride).div_ceil(2), |wide| {
                let numbers = wide.as_mut_ptr().cast::<i16>();
                // SAFETY: as above.
                unsafe {
                    let wide = std::slice::from_raw_parts_mut(numbers, count * stride);
                    dispatch_widened(filters.instructions, self, index, rows, patches, wide);
                }
            });
        });
    }
}

for_all_instructions!(fn dispatch_direct = direct(job: &Job<'_>, index: usize, rows: [usize; 2]));
for_all_instructions!(fn dispatch_bytes = bytes(job: &Job<'_>, index: usize, rows: [usize; 2], patches: &mut [u8]));
for_all_instructions!(
    fn dispatch_widened =
        widened(job: &Job<'_>, index: usize, rows: [usize; 2], patches: &mut [u8], wide: &mut [i16])
);

/// Multiplies the pixels of the input themselves.
#[inline(always)]
unsafe fn direct<V: Dots>(job: &Job<'_>, index: usize, rows: [usize; 2]) {
    let channels = job.conv.filters.channels;
    let x = &job.x[rows[0] * channels..][..rows[1] * channels];
    // SAFETY: passed on; the rows lie within the input.
    unsafe { multiply::<V>(job, index, rows, x.as_ptr(), channels) }
}

/// Multiplies patches of bytes.
#[inline(always)]
unsafe fn bytes<V: Dots>(job: &Job<'_>, index: usize, rows: [usize; 2], patches: &mut [u8]) {
    let stride = patches.len() / rows[1].max(1);
    gather(job, rows[0], patches.chunks_exact_mut(stride.max(1)));
    let flip = job.conv.filters.input.flip();
    if flip != 0 {
        patches.iter_mut().for_each(|byte| *byte ^= flip);
    }
    // SAFETY: passed on; there are as many rows.
    unsafe { multiply::<V>(job, index, rows, patches.as_ptr(), stride) }
}

/// Multiplies patches of 16-bit integers, from which the zero point has been subtracted.
#[inline(always)]
unsafe fn widened<V: Dots>(
    job: &Job<'_>,
    index: usize,
    rows: [usize; 2],
    patches: &mut [u8],
    wide: &mut [i16],
) {
    let stride = patches.len() / rows[1].max(1);
    gather(job, rows[0], patches.chunks_exact_mut(stride.max(1)));
    let input = job.conv.filters.input;
    let (flip, zero) = (input.flip(), input.unsigned() as i16);
    for (wide, &byte) in wide.iter_mut().zip(&*patches) {
        *wide = i16::from(byte ^ flip) - zero;
    }
    // SAFETY: as above.
    unsafe { multiply::<V>(job, index, rows, wide.as_ptr().cast(), 2 * stride) }
}

/// Copies the bytes below the kernel, row by row; those beside the input stand for 0.
#[inline(always)]
fn gather<'a>(job: &Job<'_>, first: usize, patches: impl Iterator<Item = &'a mut [u8]>) {
    let (window, channels) = (&job.conv.window, job.conv.filters.channels);
    let depth = channels * window.kernel[0] * window.kernel[1];
    let zero = job.conv.filters.input.zero as u8;
    let [height, width] = window.output;
    let run = window.kernel[1] * channels;
    for (pixel, patch) in patches.enumerate() {
        let pixel = first + pixel;
        let (image, oy, ox) = (pixel / (height * width), pixel / width % height, pixel % width);
        let left = (ox * window.strides[1]) as isize - window.pads[1] as isize;
        let inside =
            left >= 0 && left as usize + (window.kernel[1] - 1) * window.dilations[1] < window.input[1];
        for ky in 0..window.kernel[0] {
            let to = &mut patch[ky * run..][..run];
            let iy = (oy * window.strides[0] + ky * window.dilations[0]).wrapping_sub(window.pads[0]);
            if iy >= window.input[0] {
                to.fill(zero);
                continue;
            }
            let row = &job.x[(image * window.input[0] + iy) * window.input[1] * channels..];
            if inside && window.dilations[1] == 1 {
                copy(&row[left as usize * channels..], to);
                continue;
            }
            for (kx, to) in to.chunks_exact_mut(channels.max(1)).enumerate() {
                let ix = left + (kx * window.dilations[1]) as isize;
                if ix >= 0 && (ix as usize) < window.input[1] {
                    copy(&row[ix as usize * channels..], to);
                } else {
                    to.fill(zero);
                }
            }
        }
        // Becomes 0, which adds nothing to the sum of a row.
        patch[depth..].fill(job.conv.filters.input.flip());
    }
}

/// Copies as many bytes as `to` has; a call of `memcpy` takes longer than few bytes.
#[inline(always)]
fn copy(from: &[u8], to: &mut [u8]) {
    let from = &from[..to.len()];
    if to.len() > 16 {
        return to.copy_from_slice(from);
    }
    match (from.first_chunk::<8>(), from.last_chunk::<8>(), to.len()) {
        (Some(first), Some(last), length) => {
            let (first, last) = (*first, *last);
            to[..8].copy_from_slice(&first);
            to[length - 8..].copy_from_slice(&last);
        }
        _ => to.iter_mut().zip(from).for_each(|(to, from)| *to = *from),
    }
}

/// Multiplies rows by the panels of a share.
#[inline(always)]
unsafe fn multiply<V: Dots>(
    job: &Job<'_>,
    index: usize,
    [first, count]: [usize; 2],
    x: *const u8,
    stride: usize,
) {
    const MOST: usize = 10 * STEP;
    let filters = &*job.conv.filters;
    let mut sums = [0_i32; MOST];
    if filters.has_corrections {
        for (row, sum) in sums.iter_mut().enumerate().take(count) {
            // SAFETY: passed on.
            *sum = unsafe { V::sum_of_bytes(x.add(row * stride), stride) };
        }
    }
    let size = if job.bounds.is_some() { 1 } else { 4 };
    let rows = Rows {
        x,
        x_stride: stride,
        sums: if filters.has_corrections { sums.as_ptr() } else { std::ptr::null() },
        y: job.y.wrapping_add(first * filters.outputs * size),
        y_stride: filters.outputs,
        words: filters.words,
        count,
        bounds: job.bounds,
    };
    let panels = filters.panel_count();
    let share = index % job.shares;
    let range = panels * share / job.shares..panels * (share + 1) / job.shares;
    for index in range {
        // SAFETY: passed on; the panel lies within the weights.
        unsafe { panel::<V>(&rows, &filters.panel(index)) }
    }
}
