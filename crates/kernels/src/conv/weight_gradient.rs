//! Gradients of the weights of convolutions: dense ones tap by tap.

use super::depthwise_gradient::depthwise_weight_gradient;
use super::pixel_products::{COLUMNS, PixelProducts, ROWS};
use super::training::TrainingConvolution;
use super::winograd::Winograd;
use super::winograd_gradient::winograd_weight_gradient;
use crate::aligned::{PATCH_GRADIENTS, PATCHES, SUMS, with_buffer};
use crate::compute::Compute;
use crate::isa::for_every_isa;
use crate::lanes::Lanes;

/// Pixels that a thread packs at a time.
const PACKED: usize = 32;

/// The packed pixels of a block.
struct Block<'a> {
    conv: &'a TrainingConvolution,
    sizes: PixelProducts,
    group: usize,
    /// Taps of a plane: several ones of few channels lie side by side.
    taps: usize,
    x: *const f32,
    dy: *const f32,
    left: *mut f32,
    right: *mut f32,
    /// The first pixel of the output.
    first: usize,
}

// SAFETY: threads read the tensors and write disjoint pixels.
unsafe impl Sync for Block<'_> {}

impl TrainingConvolution {
    /// Computes the gradient of the weights from the input and the gradient of the output.
    ///
    /// # Panics
    /// When the lengths do not match.
    pub fn weight_gradient(&self, compute: &Compute, x: &[f32], dy: &[f32], dw: &mut [f32]) {
        self.check(x.len(), dw.len(), dy.len());
        if dw.is_empty() || dy.is_empty() || x.is_empty() {
            dw.fill(0.0);
            return;
        }
        if self.is_depthwise() {
            depthwise_weight_gradient(self, compute, x, dy, dw);
        } else if self.groups == 1 && Winograd::has_kernel(&self.window, [self.outputs, self.channels]) {
            winograd_weight_gradient(self, compute, x, dy, dw);
        } else {
            by_taps(self, compute, x, dy, dw);
        }
    }
}

/// Computes the gradient of the weights; the lengths have been checked.
fn by_taps(conv: &TrainingConvolution, compute: &Compute, x: &[f32], dy: &[f32], dw: &mut [f32]) {
    let (inputs, outputs, taps) = (conv.group_channels(), conv.group_outputs(), conv.taps());
    let of_plane = (COLUMNS / inputs).clamp(1, taps);
    let pixels = dy.len() / conv.outputs;
    let sizes = PixelProducts::new(taps.div_ceil(of_plane), true, [outputs, of_plane * inputs], pixels);
    let [left_length, right_length, length] = sizes.lengths();
    for (group, dw) in dw.chunks_mut(outputs * inputs * taps).enumerate() {
        with_buffer(&PATCHES, left_length, |left| {
            with_buffer(&PATCH_GRADIENTS, right_length, |right| {
                with_buffer(&SUMS, length, |sums| {
                    sums.fill(0.0);
                    for first in (0..pixels).step_by(sizes.pixels) {
                        let count = (pixels - first).min(sizes.pixels);
                        let block = Block {
                            conv,
                            sizes,
                            group,
                            taps: of_plane,
                            x: x.as_ptr(),
                            dy: dy.as_ptr(),
                            left: left.as_mut_ptr(),
                            right: right.as_mut_ptr(),
                            first,
                        };
                        compute.pool().run(count.div_ceil(PACKED), |piece| {
                            let range = [piece * PACKED, ((piece + 1) * PACKED).min(count)];
                            // SAFETY: lengths have been checked; pieces write disjoint pixels.
                            unsafe { dispatch_pack(compute.isa(), &block, range) };
                        });
                        sizes.add(compute, left, right, count, sums);
                    }
                    let sums = &*sums;
                    compute.pool().run_on_pieces(dw, inputs * taps, |output, dw| {
                        for (at, dw) in dw.iter_mut().enumerate() {
                            let (input, tap) = (at / taps, at % taps);
                            let column = tap % of_plane * inputs + input;
                            *dw = sums[tap / of_plane * sizes.plane() + sizes.at(output, column)];
                        }
                    });
                });
            });
        });
    }
}

for_every_isa!(fn dispatch_pack = pack(block: &Block<'_>, range: [usize; 2]));

/// Packs pixels of a block: of the output's gradient once, of the input for each tap.
///
/// # Safety
/// The pixels lie within the output, and the packed ones within the matrices.
#[inline(always)]
unsafe fn pack<V: Lanes>(block: &Block<'_>, [begin, end]: [usize; 2]) {
    let Block { conv, sizes, group, .. } = *block;
    let (inputs, outputs, taps) = (conv.group_channels(), conv.group_outputs(), conv.taps());
    let (input, output, kernel) = (conv.window.input, conv.window.output, conv.window.kernel);
    for at in begin..end {
        let pixel = block.first + at;
        let (row, column) = (pixel / output[1], pixel % output[1]);
        let (image, row) = (row / output[0], row % output[0]);
        // SAFETY: passed on.
        unsafe {
            let from = block.dy.add(pixel * conv.outputs + group * outputs);
            copy_strips::<V>(from, outputs, block.left.add(at * ROWS), ROWS, sizes.pixels * ROWS);
            for tap in 0..taps {
                let (plane, side) = (tap / block.taps, tap % block.taps * inputs);
                let to = (plane * sizes.strips[1] * sizes.pixels + at) * COLUMNS + side;
                let to = block.right.add(to);
                let place = |axis: usize, at: usize, tap: usize| {
                    let window = &conv.window;
                    let at = at * window.strides[axis] + tap * window.dilations[axis];
                    at.checked_sub(window.pads[axis]).filter(|&at| at < input[axis])
                };
                match (place(0, row, tap / kernel[1]), place(1, column, tap % kernel[1])) {
                    (Some(y), Some(x)) => {
                        let pixel = (image * input[0] + y) * input[1] + x;
                        let from = block.x.add(pixel * conv.channels + group * inputs);
                        copy_strips::<V>(from, inputs, to, COLUMNS, sizes.pixels * COLUMNS);
                    }
                    _ => {
                        for first in (0..inputs).step_by(COLUMNS) {
                            let to = to.add(first / COLUMNS * sizes.pixels * COLUMNS);
                            to.write_bytes(0, (inputs - first).min(COLUMNS));
                        }
                    }
                }
            }
        }
    }
}

/// Copies numbers to strips of `width` numbers that lie `step` apart.
#[inline(always)]
unsafe fn copy_strips<V: Lanes>(from: *const f32, count: usize, to: *mut f32, width: usize, step: usize) {
    for first in (0..count).step_by(V::WIDTH) {
        // SAFETY: passed on.
        unsafe {
            let (from, to) = (from.add(first), to.add(first / width * step + first % width));
            match count - first {
                left if left >= V::WIDTH => V::load(from).store(to),
                left => V::load_some(from, left).store_some(to, left),
            }
        }
    }
}
