//! Depthwise convolutions of bytes: every channel has a kernel of its own.

use std::sync::Arc;

use super::dots::Dots;
use super::filters::ByteWeights;
use super::instructions::{Instructions, for_all_instructions};
use super::output::{Bounds, ByteOutput, ByteZero};
use crate::compute::Compute;
use crate::conv::Window;
use crate::cost::LayerCost;

/// Registers of a group of channels.
const GROUP: usize = 4;
/// Bytes of a group of channels, at most.
const MAX_CHANNELS: usize = 64;

/// Packed weights and bias of a depthwise convolution, for one instruction set and one zero point of the input.
#[derive(Debug)]
pub struct ByteDepthwiseFilters {
    instructions: Instructions,
    input: ByteZero,
    channels: usize,
    kernel: [usize; 2],
    /// Per group of channels: per rows of taps and column, a word for each channel.
    words: Vec<i32>,
    /// What is left of weights beyond the range of a byte, in the same order, or empty.
    rest: Vec<i32>,
    constants: Vec<i32>,
    scales: Vec<f32>,
}

impl ByteDepthwiseFilters {
    /// Packs weights of one channel for an input of that zero point.
    ///
    /// # Panics
    /// When the lengths do not match.
    pub fn new(compute: &Compute, weights: &ByteWeights<'_>, input: ByteZero) -> Self {
        weights.check();
        assert_eq!(weights.channels, 1, "a channel has a kernel of its own");
        let instructions = Self::instructions(compute, weights);
        let (width, taps) = (instructions.width(), instructions.taps());
        let (group, [height, columns]) = (GROUP * width, weights.kernel);
        let padded = weights.outputs.next_multiple_of(group);
        let per_group = height.div_ceil(taps) * columns * group;
        let mut filters = Self {
            instructions,
            input,
            channels: weights.outputs,
            kernel: weights.kernel,
            words: vec![0; padded / group * per_group],
            rest: vec![0; padded / group * per_group],
            constants: vec![0; padded],
            scales: vec![0.0; padded],
        };
        for lane in 0..padded {
            let (register, in_register) = (lane % group / width, lane % width);
            let channel = lane / group * group + instructions.channel(register, in_register);
            if channel >= weights.outputs {
                continue;
            }
            let mut sum = 0_i32;
            for (tap, index) in (channel * height * columns..).take(height * columns).enumerate() {
                let (ky, kx) = (tap / columns, tap % columns);
                let weight = weights.number(index) - weights.zero(channel);
                sum = sum.wrapping_add(weight);
                let at = lane / group * per_group + (ky / taps * columns + kx) * group + lane % group;
                if taps == 4 {
                    let near = weight.clamp(-128, 127);
                    filters.words[at] |= (near & 0xff) << (8 * (ky % 4));
                    filters.rest[at] |= ((weight - near) & 0xff) << (8 * (ky % 4));
                } else {
                    filters.words[at] |= (weight & 0xffff) << (16 * (ky % 2));
                }
            }
            let bias = weights.bias.get(channel).copied().unwrap_or(0);
            // Of 16-bit parts the zero point has been subtracted.
            let zero = if instructions.is_bytes() { input.unsigned() } else { 0 };
            filters.constants[lane] = bias.wrapping_sub(zero.wrapping_mul(sum));
            filters.scales[lane] = weights.scale(channel);
        }
        if filters.rest.iter().all(|&word| word == 0) {
            filters.rest = Vec::new();
        }
        filters
    }

    /// Returns the instructions; a weight that is no sum of two signed bytes needs 16 bits.
    fn instructions(compute: &Compute, weights: &ByteWeights<'_>) -> Instructions {
        let best = Instructions::of(compute.isa());
        let taps = weights.kernel[0] * weights.kernel[1];
        let is_narrow = weights
            .bytes
            .iter()
            .enumerate()
            .all(|(index, _)| weights.number(index) - weights.zero(index / taps.max(1)) <= 254);
        match best {
            #[cfg(target_arch = "x86_64")]
            Instructions::Vnni if !is_narrow => Instructions::Avx2,
            best => {
                let _ = is_narrow;
                best
            }
        }
    }
}

/// A depthwise convolution of bytes of known shapes.
#[derive(Debug, Clone)]
pub struct ByteDepthwise {
    /// Weights, bias and scales.
    pub filters: Arc<ByteDepthwiseFilters>,
    /// Geometry.
    pub window: Window,
    /// Number of images.
    pub batch: usize,
    /// Quantisation of the output.
    pub output: ByteOutput,
}

impl ByteDepthwise {
    /// Returns the arithmetic and the bytes of the weights.
    pub fn cost(&self) -> LayerCost {
        let Window { kernel, output, .. } = self.window;
        let factors = [self.batch, output[0], output[1], self.filters.channels, kernel[0], kernel[1]];
        LayerCost::bytes(&factors)
            .with_weights(size_of::<i32>() * (self.filters.words.len() + self.filters.rest.len()))
    }

    /// Computes the convolution; signed bytes are given as their bits.
    ///
    /// # Panics
    /// When the slices do not have the stated shapes.
    pub fn run(&self, compute: &Compute, x: &[u8], y: &mut [u8]) {
        let Self { filters, window, batch, output } = self;
        let ([input_height, input_width], [height, width]) = (window.input, window.output);
        assert_eq!(filters.kernel, window.kernel, "the filters must have the size of the kernel");
        assert_eq!(x.len(), batch * input_height * input_width * filters.channels, "the size of the input");
        assert_eq!(y.len(), batch * height * width * filters.channels, "the size of the output");
        if y.is_empty() {
            return;
        }
        let threads = compute.pool().threads();
        let rows = height.div_ceil(if threads == 1 { 1 } else { 4 * threads });
        let job = Job {
            filters,
            window,
            bounds: output.bounds(),
            x: x.as_ptr(),
            y: y.as_mut_ptr(),
            rows,
            down: height.div_ceil(rows),
            zeros: [filters.input.zero as u8; MAX_CHANNELS],
        };
        let pieces = batch * job.down;
        // SAFETY: sizes have been checked; pieces write disjoint rows.
        let work = |piece| unsafe { dispatch_rows(filters.instructions, &job, piece) };
        let products = y.len() * window.kernel[0] * window.kernel[1];
        if products < 1 << 16 { (0..pieces).for_each(work) } else { compute.pool().run(pieces, work) }
    }
}

struct Job<'a> {
    filters: &'a ByteDepthwiseFilters,
    window: &'a Window,
    bounds: Bounds,
    x: *const u8,
    y: *mut u8,
    rows: usize,
    down: usize,
    /// What lies beside the input.
    zeros: [u8; MAX_CHANNELS],
}

// SAFETY: pieces read the input and write disjoint rows of the output.
unsafe impl Sync for Job<'_> {}

for_all_instructions!(fn dispatch_rows = rows_of_piece(job: &Job<'_>, piece: usize));

#[inline(always)]
unsafe fn rows_of_piece<V: Dots>(job: &Job<'_>, piece: usize) {
    let (image, down) = (piece / job.down, piece % job.down);
    for oy in down * job.rows..((down + 1) * job.rows).min(job.window.output[0]) {
        // SAFETY: passed on.
        unsafe {
            if job.filters.rest.is_empty() {
                row::<V, false>(job, image, oy);
            } else {
                row::<V, true>(job, image, oy);
            }
        }
    }
}

/// A group of channels of a row of the output.
struct Line<'a> {
    job: &'a Job<'a>,
    /// First byte of the group in the image.
    x: *const u8,
    /// First byte of the group in the row of the output.
    y: *mut u8,
    words: *const i32,
    rest: *const i32,
    constants: *const i32,
    scales: *const f32,
    /// Channels of the group.
    count: usize,
    /// Row of the input below the first row of taps, which may be negative.
    top: isize,
}

#[inline(always)]
unsafe fn row<V: Dots, const WIDE: bool>(job: &Job<'_>, image: usize, oy: usize) {
    let (window, filters) = (job.window, job.filters);
    let channels = filters.channels;
    let group = GROUP * V::WIDTH;
    let per_group = window.kernel[0].div_ceil(V::TAPS) * window.kernel[1] * group;
    for (index, first) in (0..channels).step_by(group).enumerate() {
        let y = ((image * window.output[0] + oy) * window.output[1]) * channels + first;
        // SAFETY: passed on; the group lies within the weights.
        unsafe {
            let line = Line {
                job,
                x: job.x.add(image * window.input[0] * window.input[1] * channels + first),
                y: job.y.add(y),
                words: filters.words.as_ptr().add(index * per_group),
                rest: filters.rest.as_ptr().wrapping_add(index * per_group),
                constants: filters.constants.as_ptr().add(first),
                scales: filters.scales.as_ptr().add(first),
                count: (channels - first).min(group),
                top: (oy * window.strides[0]) as isize - window.pads[0] as isize,
            };
            match (window.kernel[1], window.strides[1], V::PIXELS) {
                (3, 1, 4) => phases::<V, WIDE, 4, 1, 3>(&line),
                (3, 1, 2) => phases::<V, WIDE, 2, 1, 3>(&line),
                (3, 2, 4) if window.dilations[1] == 1 => phases::<V, WIDE, 4, 2, 3>(&line),
                (5, 1, 4) => phases::<V, WIDE, 4, 1, 5>(&line),
                _ => phases::<V, WIDE, 1, 1, 0>(&line),
            }
        }
    }
}

/// Computes a row in blocks of `B` pixels. Those of a block are as far apart as taps are: pixels of a block share the
/// columns of the input.
#[inline(always)]
unsafe fn phases<V: Dots, const WIDE: bool, const B: usize, const S: usize, const K: usize>(line: &Line<'_>) {
    let width = line.job.window.output[1];
    let apart = if B == 1 { 1 } else { line.job.window.dilations[1] };
    for phase in 0..apart.min(width) {
        let mut ox = phase;
        // SAFETY: passed on; the last pixel of a block lies within the row.
        unsafe {
            while ox + (B - 1) * apart < width {
                block::<V, WIDE, B, S, K>(line, ox, apart);
                ox += B * apart;
            }
            while ox < width {
                block::<V, WIDE, 1, S, K>(line, ox, apart);
                ox += apart;
            }
        }
    }
}

/// Computes `B` pixels of a group of channels; `K` is the width of the kernel, or 0 where it is not known.
#[inline(always)]
unsafe fn block<V: Dots, const WIDE: bool, const B: usize, const S: usize, const K: usize>(
    line: &Line<'_>,
    ox: usize,
    apart: usize,
) {
    let window = line.job.window;
    let channels = line.job.filters.channels;
    let kernel = if K == 0 { window.kernel[1] } else { K };
    let input = line.job.filters.input;
    let group = GROUP * V::WIDTH;
    let left = (ox * window.strides[1]) as isize - window.pads[1] as isize;
    // SAFETY: rows and columns within the input are read, and zeros beside it.
    unsafe {
        let mut sums = [[V::splat(0); GROUP]; B];
        for g in 0..GROUP {
            let start = V::load(line.constants.add(g * V::WIDTH));
            for o in 0..B {
                sums[o][g] = start;
            }
        }
        for quad in 0..window.kernel[0].div_ceil(V::TAPS) {
            let zeros = line.job.zeros.as_ptr();
            // Rows beside the input: every column of them is zero.
            let mut rows = [(zeros, 0); 4];
            for part in 0..V::TAPS {
                let ky = quad * V::TAPS + part;
                let iy = line.top + (ky * window.dilations[0]) as isize;
                if ky < window.kernel[0] && iy >= 0 && (iy as usize) < window.input[0] {
                    rows[part] = (line.x.add(iy as usize * window.input[1] * channels), channels);
                }
            }
            for c in 0..(B - 1) * S + kernel {
                let ix = left + (c * window.dilations[1]) as isize;
                let inside = ix >= 0 && (ix as usize) < window.input[1];
                let mut pointers = [zeros; 4];
                if inside {
                    for part in 0..V::TAPS {
                        pointers[part] = rows[part].0.add(ix as usize * rows[part].1);
                    }
                }
                let column = V::column(&pointers, line.count, input.flip(), input.unsigned());
                for o in 0..B {
                    if c < o * S || c - o * S >= kernel {
                        continue;
                    }
                    let at = (quad * kernel + c - o * S) * group;
                    for g in 0..GROUP {
                        sums[o][g] = sums[o][g].dot(column[g], V::load(line.words.add(at + g * V::WIDTH)));
                        if WIDE {
                            sums[o][g] = sums[o][g].dot(column[g], V::load(line.rest.add(at + g * V::WIDTH)));
                        }
                    }
                }
            }
        }
        for o in 0..B {
            let to = line.y.add((ox + o * apart) * channels);
            V::store_column(&sums[o], line.scales, &line.job.bounds, to, line.count);
        }
    }
}
