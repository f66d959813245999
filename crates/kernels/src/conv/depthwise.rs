//! Depthwise convolutions: every channel has a kernel of its own.

use std::sync::Arc;

use super::geometry::{Finish, Strides, Window};
use crate::aligned::{AlignedBuffer, flush_below, negligible};
use crate::compute::Compute;
use crate::cost::LayerCost;
use crate::isa::{Isa, for_every_isa};
use crate::lanes::Lanes;
use crate::unary::{Unary, unary_all};

/// Packed weights and bias of a depthwise convolution.
#[derive(Debug)]
pub struct DepthwiseFilters {
    channels: usize,
    /// Channels, rounded up to whole registers of any instruction set.
    padded: usize,
    kernel: [usize; 2],
    /// A row of all channels per tap, and one of the bias.
    rows: AlignedBuffer,
}

/// Output pixels that are computed at a time.
const PIXELS: usize = 6;

impl DepthwiseFilters {
    /// Packs weights of the shape `[channels, 1, height, width]`. Weights below 1e-20 of the largest one count as zero.
    ///
    /// # Panics
    /// When the lengths do not match.
    pub fn new(weights: &[f32], channels: usize, kernel: [usize; 2], bias: Option<&[f32]>) -> Self {
        let taps = kernel[0] * kernel[1];
        assert_eq!(weights.len(), channels * taps, "the weights must have the stated shape");
        let padded = channels.next_multiple_of(crate::lanes::MAX_WIDTH);
        let mut rows = AlignedBuffer::default();
        let all = rows.take((taps + 1) * padded);
        for (channel, weights) in weights.chunks(taps.max(1)).enumerate() {
            for (tap, &weight) in weights.iter().enumerate() {
                all[tap * padded + channel] = weight;
            }
        }
        flush_below(&mut all[..taps * padded], negligible(weights));
        if let Some(bias) = bias {
            assert_eq!(bias.len(), channels, "one bias per channel");
            all[taps * padded..][..channels].copy_from_slice(bias);
        }
        Self { channels, padded, kernel, rows }
    }

    /// Returns the number of channels.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Returns the bytes of the packed weights.
    pub fn bytes(&self) -> usize {
        size_of::<f32>() * (self.kernel[0] * self.kernel[1] + 1) * self.padded
    }

    /// Returns `values`, one per channel, filled up as the rows of weights are.
    pub fn padded(&self, values: &[f32]) -> Vec<f32> {
        let mut all = values.to_vec();
        all.resize(self.padded, 0.0);
        all
    }
}

/// A depthwise convolution of known shapes.
#[derive(Debug, Clone)]
pub struct DepthwiseConvolution {
    /// Weights and bias.
    pub filters: Arc<DepthwiseFilters>,
    /// Geometry.
    pub window: Window,
    /// Number of images.
    pub batch: usize,
    /// Layout of the input; channels lie side by side.
    pub x: Strides,
    /// Layout of the output; channels lie side by side.
    pub y: Strides,
    /// What follows the sums. There is no residual.
    pub finish: Finish,
}

impl DepthwiseConvolution {
    /// Returns the arithmetic and the bytes of the weights.
    pub fn cost(&self) -> LayerCost {
        let Window { kernel, output, .. } = self.window;
        let factors = [self.batch, output[0], output[1], self.filters.channels(), kernel[0], kernel[1]];
        LayerCost::floats(&factors).with_weights(self.filters.bytes())
    }

    /// Computes the convolution.
    ///
    /// # Panics
    /// When the slices are shorter than the shapes and strides require.
    pub fn run(&self, compute: &Compute, x: &[f32], y: &mut [f32]) {
        // SAFETY: the output has that length.
        unsafe { self.run_to(compute, x, y.as_mut_ptr(), y.len()) }
    }

    /// Computes the convolution to `length` numbers, none of which is read before it is written.
    ///
    /// # Safety
    /// The numbers may be written, and nothing else uses them.
    pub(super) unsafe fn run_to(&self, compute: &Compute, x: &[f32], y: *mut f32, length: usize) {
        if self.is_empty() {
            return;
        }
        self.check(x);
        assert!(length >= self.reach(self.y, self.window.output), "the output is too short");
        let threads = compute.pool().threads();
        let rows = self.window.output[0].div_ceil(if threads == 1 { 1 } else { 4 * threads }).max(1);
        let job = Job { y, ..self.job(x, rows) };
        let isa: Isa = compute.isa();
        // SAFETY: sizes have been checked; pieces write disjoint rows.
        let work = |piece| unsafe { job.run(isa, piece) };
        if self.products() < 1 << 15 {
            (0..job.pieces()).for_each(work)
        } else {
            compute.pool().run(job.pieces(), work)
        }
    }

    /// Returns whether the output has no elements.
    pub(super) fn is_empty(&self) -> bool {
        self.batch == 0 || self.window.output.contains(&0) || self.filters.channels == 0
    }

    /// Returns the number of multiplications.
    fn products(&self) -> usize {
        let [height, width] = self.window.output;
        let kernel = self.filters.kernel;
        self.batch * height * width * self.filters.channels * kernel[0] * kernel[1]
    }

    fn reach(&self, at: Strides, [height, width]: [usize; 2]) -> usize {
        (self.batch - 1) * at.image
            + height.saturating_sub(1) * at.row
            + width.saturating_sub(1) * at.pixel
            + self.filters.channels
    }

    /// Panics where the input, filters and strides do not fit.
    pub(super) fn check(&self, x: &[f32]) {
        let Self { filters, window, x: x_strides, y: y_strides, finish, .. } = self;
        assert_eq!(x_strides.channel, 1, "the channels of the input must lie side by side");
        assert_eq!(filters.kernel, window.kernel, "the filters must have the size of the kernel");
        y_strides.check_written(window.output, filters.channels);
        let is_long = window.input.contains(&0) || x.len() >= self.reach(*x_strides, window.input);
        assert!(is_long, "the input is too short");
        if let Some(slopes) = &finish.slopes {
            assert!(slopes.len() >= filters.padded, "one slope per channel, rounded up");
        }
    }

    /// Divides the output into pieces of `rows` rows.
    pub(super) fn job<'a>(&'a self, x: &'a [f32], rows: usize) -> Job<'a> {
        let all = [f32::NEG_INFINITY, f32::INFINITY];
        let (clamp, then) = match self.finish.activation {
            _ if self.finish.slopes.is_some() => (all, Unary::Identity),
            Unary::Relu => ([0.0, f32::INFINITY], Unary::Identity),
            Unary::Clip { low, high } => ([low, high], Unary::Identity),
            other => (all, other),
        };
        let Self { filters, window, batch, x: x_strides, y: y_strides, finish } = self;
        Job {
            filters,
            window,
            finish,
            batch: *batch,
            x_strides: *x_strides,
            y_strides: *y_strides,
            x: x.as_ptr(),
            y: std::ptr::null_mut(),
            rows,
            down: window.output[0].div_ceil(rows),
            clamp,
            then,
        }
    }
}

/// A convolution in pieces of rows.
#[derive(Clone, Copy)]
pub(super) struct Job<'a> {
    filters: &'a DepthwiseFilters,
    window: &'a Window,
    finish: &'a Finish,
    batch: usize,
    x_strides: Strides,
    y_strides: Strides,
    x: *const f32,
    y: *mut f32,
    /// Rows of a piece, and pieces of an image.
    rows: usize,
    down: usize,
    clamp: [f32; 2],
    /// What follows the bounds, row by row.
    then: Unary,
}

// SAFETY: pieces read the inputs and write disjoint rows of the output.
unsafe impl Sync for Job<'_> {}

impl Job<'_> {
    pub(super) fn pieces(&self) -> usize {
        self.batch * self.down
    }

    /// Returns the image of a piece, and its rows.
    pub(super) fn rows(&self, piece: usize) -> (usize, std::ops::Range<usize>) {
        let first = piece % self.down * self.rows;
        (piece / self.down, first..(first + self.rows).min(self.window.output[0]))
    }

    /// Computes a piece.
    ///
    /// # Safety
    /// The sizes have been checked; nothing else uses the rows of the piece.
    unsafe fn run(&self, isa: Isa, piece: usize) {
        // SAFETY: passed on.
        unsafe { dispatch_rows(isa, self, piece) }
    }

    /// Computes the rows of a piece to `y`, as they would follow each other in the output.
    ///
    /// # Safety
    /// The input has been checked; `y` has the length of the rows.
    pub(super) unsafe fn run_to(&self, isa: Isa, piece: usize, y: &mut [f32]) {
        let (image, rows) = self.rows(piece);
        let before = image * self.y_strides.image + rows.start * self.y_strides.row;
        let job = Self { y: y.as_mut_ptr().wrapping_sub(before), ..*self };
        // SAFETY: the rows of the piece lie in `y`.
        unsafe { job.run(isa, piece) }
    }
}

for_every_isa!(fn dispatch_rows = rows_of_piece(job: &Job<'_>, piece: usize));

#[inline(always)]
unsafe fn rows_of_piece<V: Lanes>(job: &Job<'_>, piece: usize) {
    let window = job.window;
    let (image, rows) = job.rows(piece);
    for oy in rows {
        // SAFETY: passed on.
        unsafe {
            match (window.kernel[1], window.strides[1], window.dilations[1]) {
                (1, 1, _) => row::<V, 1, 1>(job, image, oy),
                (3, 1, 1) => row::<V, 3, 1>(job, image, oy),
                (3, 2, 1) => row::<V, 3, 2>(job, image, oy),
                (5, 1, 1) => row::<V, 5, 1>(job, image, oy),
                (5, 2, 1) => row::<V, 5, 2>(job, image, oy),
                _ => row::<V, 0, 0>(job, image, oy),
            }
            if job.then != Unary::Identity {
                let y = job.y.wrapping_add(image * job.y_strides.image + oy * job.y_strides.row);
                let (pixels, channels) = (window.output[1], job.filters.channels);
                if job.y_strides.pixel == channels {
                    unary_all::<V>(job.then, y, y, pixels * channels);
                } else {
                    for ox in 0..pixels {
                        let y = y.add(ox * job.y_strides.pixel);
                        unary_all::<V>(job.then, y, y, channels);
                    }
                }
            }
        }
    }
}

/// What all pixels of a row of the output share.
struct Row<'a> {
    job: &'a Job<'a>,
    /// The first row of taps that lies within the input, of the image's first pixel.
    x: *const f32,
    /// Distance between rows of taps.
    x_row: usize,
    /// The row of the output.
    y: *mut f32,
    /// Rows of taps that lie within the input.
    taps: [usize; 2],
    slopes: *const f32,
}

/// Computes a row of the output; `K` and `S` are kernel width and stride, or 0 where there is no loop for them.
#[inline(always)]
unsafe fn row<V: Lanes, const K: usize, const S: usize>(job: &Job<'_>, image: usize, oy: usize) {
    let window = job.window;
    let input_row = window.first_tap(0, oy);
    let taps = window.taps_inside(0, input_row);
    let first_row = input_row + (taps[0] * window.dilations[0]) as isize;
    let width = window.output[1];
    // Output pixels all of whose taps lie within the row.
    let [left, right] = if K == 0 {
        [width, width]
    } else {
        let left = window.pads[1].div_ceil(S).min(width);
        let right =
            (window.input[1] + window.pads[1]).checked_sub(K).map_or(0, |last| last / S + 1).min(width);
        [left, right.max(left)]
    };
    // SAFETY: channels and pixels lie within the tensors, whose sizes have been checked; without taps nothing is read.
    unsafe {
        let x = image * job.x_strides.image + first_row.max(0) as usize * job.x_strides.row;
        let row = Row {
            job,
            x: job.x.wrapping_add(x),
            x_row: window.dilations[0] * job.x_strides.row,
            y: job.y.wrapping_add(image * job.y_strides.image + oy * job.y_strides.row),
            taps,
            slopes: job.finish.slopes.as_ref().map_or(std::ptr::null(), |slopes| slopes.as_ptr()),
        };
        let mut ox = 0;
        while ox < width {
            // All channels of a few pixels, which lie side by side: memory is read and written in its order.
            let pixels = match right.saturating_sub(ox) {
                _ if ox < left || ox >= right => 0,
                PIXELS.. => PIXELS,
                4..PIXELS => 4,
                2..4 => 2,
                _ => 1,
            };
            match pixels {
                0 => edge::<V>(&row, ox),
                PIXELS => inner::<V, K, S, PIXELS>(&row, ox),
                4 => inner::<V, K, S, 4>(&row, ox),
                2 => inner::<V, K, S, 2>(&row, ox),
                _ => inner::<V, K, S, 1>(&row, ox),
            }
            ox += pixels.max(1);
        }
    }
}

#[inline(always)]
unsafe fn load<V: Lanes, const WHOLE: bool>(from: *const f32, count: usize) -> V {
    // SAFETY: passed on.
    unsafe { if WHOLE { V::load(from) } else { V::load_some(from, count) } }
}

/// Computes pixels all of whose taps lie within their rows of the input.
#[inline(always)]
unsafe fn inner<V: Lanes, const K: usize, const S: usize, const R: usize>(row: &Row<'_>, ox: usize) {
    let channels = row.job.filters.channels;
    let whole = channels / V::WIDTH * V::WIDTH;
    // SAFETY: passed on.
    unsafe {
        let x = row.x.wrapping_add((ox * S - row.job.window.pads[1]) * row.job.x_strides.pixel);
        for channel in (0..whole).step_by(V::WIDTH) {
            tile::<V, K, S, R, true>(row, x, ox, channel, V::WIDTH);
        }
        if whole < channels {
            tile::<V, K, S, R, false>(row, x, ox, whole, channels - whole);
        }
    }
}

/// Computes `count` channels of pixels whose taps begin at `x`.
#[inline(always)]
unsafe fn tile<V: Lanes, const K: usize, const S: usize, const R: usize, const WHOLE: bool>(
    row: &Row<'_>,
    x: *const f32,
    ox: usize,
    channel: usize,
    count: usize,
) {
    let (padded, pixel) = (row.job.filters.padded, row.job.x_strides.pixel);
    // SAFETY: passed on.
    unsafe {
        let mut sums = [V::splat(0.0); R];
        let mut line = x.wrapping_add(channel);
        let mut weights = row.job.filters.rows.start().add(row.taps[0] * K * padded + channel);
        for _ in row.taps[0]..row.taps[1] {
            if S == 1 {
                // Pixels are loaded once for all taps of the row.
                let mut pixels = [V::splat(0.0); 10];
                for (i, value) in pixels.iter_mut().enumerate().take(R - 1 + K) {
                    *value = load::<V, WHOLE>(line.add(i * pixel), count);
                }
                for kx in 0..K {
                    let weight = V::load(weights.add(kx * padded));
                    for (i, sum) in sums.iter_mut().enumerate() {
                        *sum = pixels[i + kx].mul_add(weight, *sum);
                    }
                }
            } else {
                for kx in 0..K {
                    let weight = V::load(weights.add(kx * padded));
                    for (i, sum) in sums.iter_mut().enumerate() {
                        let value: V = load::<V, WHOLE>(line.add((i * S + kx) * pixel), count);
                        *sum = value.mul_add(weight, *sum);
                    }
                }
            }
            line = line.wrapping_add(row.x_row);
            weights = weights.wrapping_add(K * padded);
        }
        finish::<V, R, WHOLE>(row, ox, channel, count, &sums);
    }
}

/// Computes one output pixel, some of whose taps may lie beside the input.
#[inline(always)]
unsafe fn edge<V: Lanes>(row: &Row<'_>, ox: usize) {
    let (window, filters) = (row.job.window, row.job.filters);
    let dilation = window.dilations[1];
    let x = window.first_tap(1, ox);
    let [first, end] = window.taps_inside(1, x);
    let left = (x + (first * dilation) as isize).max(0) as usize * row.job.x_strides.pixel;
    let step = dilation * row.job.x_strides.pixel;
    // SAFETY: passed on; taps beside the input are left out.
    unsafe {
        for channel in (0..filters.channels).step_by(V::WIDTH) {
            let count = (filters.channels - channel).min(V::WIDTH);
            let mut sum = V::splat(0.0);
            for ky in row.taps[0]..row.taps[1] {
                let line = row.x.wrapping_add((ky - row.taps[0]) * row.x_row + left + channel);
                let weights =
                    filters.rows.start().add((ky * window.kernel[1] + first) * filters.padded + channel);
                for kx in 0..end - first {
                    let value: V = load::<V, false>(line.wrapping_add(kx * step), count);
                    sum = value.mul_add(V::load(weights.wrapping_add(kx * filters.padded)), sum);
                }
            }
            finish::<V, 1, false>(row, ox, channel, count, &[sum]);
        }
    }
}

/// Adds the bias, last for the reason given in the tiles of dense convolutions, applies the activation function and stores.
#[inline(always)]
unsafe fn finish<V: Lanes, const R: usize, const WHOLE: bool>(
    row: &Row<'_>,
    ox: usize,
    channel: usize,
    count: usize,
    sums: &[V; R],
) {
    let job = row.job;
    // SAFETY: passed on.
    unsafe {
        let y = row.y.add(ox * job.y_strides.pixel + channel);
        let taps = job.window.kernel[0] * job.window.kernel[1];
        let bias = V::load(job.filters.rows.start().add(taps * job.filters.padded + channel));
        let [low, high] = job.clamp.map(|bound| V::splat(bound));
        for (i, &sum) in sums.iter().enumerate() {
            let mut value = sum.add(bias);
            if row.slopes.is_null() {
                value = high.min(low.max(value));
            } else {
                let zero = V::splat(0.0);
                value = V::load(row.slopes.add(channel)).mul_add(zero.min(value), zero.max(value));
            }
            let to = y.add(i * job.y_strides.pixel);
            if WHOLE { value.store(to) } else { value.store_some(to, count) }
        }
    }
}
