//! Depthwise convolutions: every channel has a kernel of its own.

use std::sync::Arc;

use super::geometry::{Finish, Strides, Window};
use crate::aligned::AlignedBuffer;
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
    /// Packs weights of the shape `[channels, 1, height, width]`.
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
        let Self { filters, window, batch, x: x_strides, y: y_strides, finish } = self;
        let (batch, x_strides, y_strides) = (*batch, *x_strides, *y_strides);
        if batch == 0 || window.output.contains(&0) || filters.channels == 0 {
            return;
        }
        let reach = |at: Strides, [height, width]: [usize; 2]| {
            (batch - 1) * at.image
                + height.saturating_sub(1) * at.row
                + width.saturating_sub(1) * at.pixel
                + filters.channels
        };
        assert_eq!(x_strides.channel, 1, "the channels of the input must lie side by side");
        assert_eq!(filters.kernel, window.kernel, "the filters must have the size of the kernel");
        y_strides.check_written(window.output, filters.channels);
        assert!(
            window.input.contains(&0) || x.len() >= reach(x_strides, window.input),
            "the input is too short"
        );
        assert!(y.len() >= reach(y_strides, window.output), "the output is too short");
        if let Some(slopes) = &finish.slopes {
            assert!(slopes.len() >= filters.padded, "one slope per channel, rounded up");
        }
        let [height, width] = window.output;
        let threads = compute.pool().threads();
        let rows = height.div_ceil(if threads == 1 { 1 } else { 4 * threads }).max(1);
        let down = height.div_ceil(rows);
        let all = [f32::NEG_INFINITY, f32::INFINITY];
        let (clamp, then) = match finish.activation {
            _ if finish.slopes.is_some() => (all, Unary::Identity),
            Unary::Relu => ([0.0, f32::INFINITY], Unary::Identity),
            Unary::Clip { low, high } => ([low, high], Unary::Identity),
            other => (all, other),
        };
        let job = Job {
            filters,
            window,
            finish,
            x_strides,
            y_strides,
            x: x.as_ptr(),
            y: y.as_mut_ptr(),
            rows,
            down,
            clamp,
            then,
        };
        let isa: Isa = compute.isa();
        // SAFETY: sizes have been checked; pieces write disjoint rows.
        let work = |piece| unsafe { dispatch_rows(isa, &job, piece) };
        let products = batch * height * width * filters.channels * filters.kernel[0] * filters.kernel[1];
        if products < 1 << 15 {
            (0..batch * down).for_each(work)
        } else {
            compute.pool().run(batch * down, work)
        }
    }
}

struct Job<'a> {
    filters: &'a DepthwiseFilters,
    window: &'a Window,
    finish: &'a Finish,
    x_strides: Strides,
    y_strides: Strides,
    x: *const f32,
    y: *mut f32,
    rows: usize,
    down: usize,
    clamp: [f32; 2],
    /// What follows the bounds, row by row.
    then: Unary,
}

// SAFETY: pieces read the inputs and write disjoint rows of the output.
unsafe impl Sync for Job<'_> {}

for_every_isa!(fn dispatch_rows = rows_of_piece(job: &Job<'_>, piece: usize));

#[inline(always)]
unsafe fn rows_of_piece<V: Lanes>(job: &Job<'_>, piece: usize) {
    let window = job.window;
    let (image, down) = (piece / job.down, piece % job.down);
    for oy in down * job.rows..((down + 1) * job.rows).min(window.output[0]) {
        // SAFETY: passed on.
        unsafe {
            match (window.kernel[1], window.strides[1], window.dilations[1]) {
                (3, 1, 1) => row::<V, 3, 1>(job, image, oy),
                (3, 2, 1) => row::<V, 3, 2>(job, image, oy),
                (5, 1, 1) => row::<V, 5, 1>(job, image, oy),
                (5, 2, 1) => row::<V, 5, 2>(job, image, oy),
                _ => row::<V, 0, 0>(job, image, oy),
            }
            if job.then != Unary::Identity {
                let y = job.y.add(image * job.y_strides.image + oy * job.y_strides.row);
                for ox in 0..window.output[1] {
                    let y = y.add(ox * job.y_strides.pixel);
                    unary_all::<V>(job.then, y, y, job.filters.channels);
                }
            }
        }
    }
}

struct Taps {
    x: *const f32,
    weights: *const f32,
    first: usize,
    end: usize,
    input_row: isize,
}

/// Computes a row of the output; `K` and `S` are kernel width and stride, or 0 where there is no loop for them.
#[inline(always)]
unsafe fn row<V: Lanes, const K: usize, const S: usize>(job: &Job<'_>, image: usize, oy: usize) {
    let (window, filters) = (job.window, job.filters);
    let input_row = (oy * window.strides[0]) as isize - window.pads[0] as isize;
    let inside = |ky: usize| {
        let y = input_row + (ky * window.dilations[0]) as isize;
        y >= 0 && y < window.input[0] as isize
    };
    let first = (0..window.kernel[0]).find(|&ky| inside(ky)).unwrap_or(0);
    let end = (0..window.kernel[0]).rev().find(|&ky| inside(ky)).map_or(first, |ky| ky + 1);
    let width = window.output[1];
    // Output pixels all of whose taps lie within the row.
    let (left, right) = if K == 0 {
        (width, width)
    } else {
        let left = window.pads[1].div_ceil(S).min(width);
        let right =
            (window.input[1] + window.pads[1]).checked_sub(K).map_or(0, |last| last / S + 1).min(width);
        (left, right.max(left))
    };
    // SAFETY: channels and pixels lie within the tensors, whose sizes have been checked.
    unsafe {
        for channel in (0..filters.channels).step_by(V::WIDTH) {
            let count = (filters.channels - channel).min(V::WIDTH);
            let taps = Taps {
                x: job.x.add(image * job.x_strides.image + channel),
                weights: filters.rows.start().add(channel),
                first,
                end,
                input_row,
            };
            let mut ox = 0;
            while ox < width {
                if ox >= left && ox + PIXELS <= right {
                    let sums = inner::<V, K, S>(job, &taps, ox, count);
                    finish(job, image, oy, ox, channel, &sums, count);
                    ox += PIXELS;
                } else {
                    let sum = edge::<V>(job, &taps, ox, count);
                    finish(job, image, oy, ox, channel, &[sum], count);
                    ox += 1;
                }
            }
        }
    }
}

#[inline(always)]
unsafe fn load<V: Lanes>(from: *const f32, count: usize) -> V {
    // SAFETY: passed on.
    unsafe { if count == V::WIDTH { V::load(from) } else { V::load_some(from, count) } }
}

#[inline(always)]
unsafe fn inner<V: Lanes, const K: usize, const S: usize>(
    job: &Job<'_>,
    taps: &Taps,
    ox: usize,
    count: usize,
) -> [V; PIXELS] {
    let padded = job.filters.padded;
    // SAFETY: passed on; all taps lie within the input.
    unsafe {
        let mut sums = [V::splat(0.0); PIXELS];
        let left = ox * S - job.window.pads[1];
        for ky in taps.first..taps.end {
            let y = (taps.input_row + (ky * job.window.dilations[0]) as isize) as usize;
            let line = taps.x.add(y * job.x_strides.row + left * job.x_strides.pixel);
            let weights = taps.weights.add(ky * K * padded);
            if S == 1 {
                // Pixels are loaded once for all taps of the row.
                let mut pixels = [V::splat(0.0); 10];
                for (i, pixel) in pixels.iter_mut().enumerate().take(PIXELS - 1 + K) {
                    *pixel = load(line.add(i * job.x_strides.pixel), count);
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
                        let pixel: V = load(line.add((i * S + kx) * job.x_strides.pixel), count);
                        *sum = pixel.mul_add(weight, *sum);
                    }
                }
            }
        }
        sums
    }
}

/// Computes one output pixel, some of whose taps may lie beside the input.
#[inline(always)]
unsafe fn edge<V: Lanes>(job: &Job<'_>, taps: &Taps, ox: usize, count: usize) -> V {
    let (window, padded) = (job.window, job.filters.padded);
    // SAFETY: passed on; taps beside the input are left out.
    unsafe {
        let mut sum = V::splat(0.0);
        for ky in taps.first..taps.end {
            let y = (taps.input_row + (ky * window.dilations[0]) as isize) as usize;
            for kx in 0..window.kernel[1] {
                let x =
                    (ox * window.strides[1] + kx * window.dilations[1]) as isize - window.pads[1] as isize;
                if x >= 0 && x < window.input[1] as isize {
                    let at = taps.x.add(y * job.x_strides.row + x as usize * job.x_strides.pixel);
                    let weight = V::load(taps.weights.add((ky * window.kernel[1] + kx) * padded));
                    let pixel: V = load(at, count);
                    sum = pixel.mul_add(weight, sum);
                }
            }
        }
        sum
    }
}

/// Adds the bias, last for the reason given in the tiles of dense convolutions, applies the activation function and stores.
#[inline(always)]
unsafe fn finish<V: Lanes, const R: usize>(
    job: &Job<'_>,
    image: usize,
    oy: usize,
    ox: usize,
    channel: usize,
    sums: &[V; R],
    count: usize,
) {
    // SAFETY: passed on.
    unsafe {
        let y = job
            .y
            .add(image * job.y_strides.image + oy * job.y_strides.row + ox * job.y_strides.pixel + channel);
        let zero = V::splat(0.0);
        let taps = job.window.kernel[0] * job.window.kernel[1];
        let bias = V::load(job.filters.rows.start().add(taps * job.filters.padded + channel));
        let slope = job.finish.slopes.as_ref().map(|slopes| V::load(slopes.as_ptr().add(channel)));
        for (i, &sum) in sums.iter().enumerate() {
            let sum = sum.add(bias);
            let value = match slope {
                Some(slope) => slope.mul_add(zero.min(sum), zero.max(sum)),
                None => V::splat(job.clamp[1]).min(V::splat(job.clamp[0]).max(sum)),
            };
            let to = y.add(i * job.y_strides.pixel);
            if count == V::WIDTH { value.store(to) } else { value.store_some(to, count) }
        }
    }
}
