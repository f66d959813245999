//! Gradients of weights of 3x3 taps by fewer products: those of Winograd's transforms of input and output ([`super::winograd`]).

use super::pixel_products::{COLUMNS, PixelProducts, ROWS};
use super::training::TrainingConvolution;
use super::winograd::{PRODUCTS, Plane, SIZE, TILE, of_input};
use crate::aligned::{PATCH_GRADIENTS, PATCHES, SUMS, with_buffer};
use crate::compute::Compute;
use crate::isa::for_every_isa;
use crate::lanes::{Lanes, MAX_WIDTH};

/// Tiles that a thread transforms at a time.
const TRANSFORMED: usize = 4;

/// Taps of the kernel along an axis.
const TAPS: usize = 3;

/// The transformed tiles of a block.
struct Block<'a> {
    conv: &'a TrainingConvolution,
    sizes: PixelProducts,
    x: *const f32,
    dy: *const f32,
    left: *mut f32,
    right: *mut f32,
    /// The first tile, and tiles down and across an image.
    first: usize,
    tiles: [usize; 2],
}

// SAFETY: threads read the tensors and write disjoint tiles.
unsafe impl Sync for Block<'_> {}

/// Computes the gradient of the weights of a convolution of 3x3 taps without strides; the lengths have been checked.
pub(super) fn winograd_weight_gradient(
    conv: &TrainingConvolution,
    compute: &Compute,
    x: &[f32],
    dy: &[f32],
    dw: &mut [f32],
) {
    let (channels, outputs) = (conv.channels, conv.outputs);
    let tiles = conv.window.output.map(|size| size.div_ceil(TILE));
    let all = conv.batch * tiles[0] * tiles[1];
    let sizes = PixelProducts::new(PRODUCTS, false, [outputs, channels], all);
    let [left_length, right_length, length] = sizes.lengths();
    with_buffer(&PATCHES, left_length, |left| {
        with_buffer(&PATCH_GRADIENTS, right_length, |right| {
            with_buffer(&SUMS, length, |sums| {
                sums.fill(0.0);
                for first in (0..all).step_by(sizes.pixels) {
                    let count = (all - first).min(sizes.pixels);
                    let block = Block {
                        conv,
                        sizes,
                        x: x.as_ptr(),
                        dy: dy.as_ptr(),
                        left: left.as_mut_ptr(),
                        right: right.as_mut_ptr(),
                        first,
                        tiles,
                    };
                    compute.pool().run(count.div_ceil(TRANSFORMED), |piece| {
                        let range = [piece * TRANSFORMED, ((piece + 1) * TRANSFORMED).min(count)];
                        // SAFETY: lengths have been checked; pieces write disjoint tiles.
                        unsafe { dispatch_transform(compute.isa(), &block, range) };
                    });
                    sizes.add(compute, left, right, count, sums);
                }
                let sums = &*sums;
                compute.pool().run_on_pieces(dw, channels * TAPS * TAPS, |output, dw| {
                    // SAFETY: the sums have the planes of the sizes.
                    unsafe { dispatch_taps(compute.isa(), &sizes, sums, output, dw) };
                });
            });
        });
    });
}

for_every_isa!(fn dispatch_transform = transform(block: &Block<'_>, tiles: [usize; 2]));

/// Writes `B^T x B` and `A dy A^T` of tiles of a block.
///
/// # Safety
/// The tensors have the sizes of the convolution; the tiles lie within the matrices.
#[inline(always)]
unsafe fn transform<V: Lanes>(block: &Block<'_>, [begin, end]: [usize; 2]) {
    let Block { conv, sizes, .. } = *block;
    let [down, across] = block.tiles;
    let [row_strips, column_strips] = sizes.strips;
    for at in begin..end {
        let tile = block.first + at;
        let (image, place) = (tile / (down * across), tile % (down * across));
        let (row, column) = (place / across * TILE, place % across * TILE);
        let corner =
            [row as isize - conv.window.pads[0] as isize, column as isize - conv.window.pads[1] as isize];
        for channel in (0..conv.channels).step_by(V::WIDTH) {
            let count = (conv.channels - channel).min(V::WIDTH);
            // SAFETY: pixels outside of the image are not read.
            unsafe {
                let plane = Plane { start: block.x, image, size: conv.window.input, channels: conv.channels };
                let mut patch = plane.patch::<V, SIZE>(corner, channel, count);
                for line in &mut patch {
                    *line = of_input(*line);
                }
                let strip = channel / COLUMNS * sizes.pixels * COLUMNS;
                let to = block.right.add(strip + at * COLUMNS + channel % COLUMNS);
                let step = column_strips * sizes.pixels * COLUMNS;
                for j in 0..SIZE {
                    for (i, value) in of_input(patch.map(|line| line[j])).into_iter().enumerate() {
                        value.store(to.add((i * SIZE + j) * step));
                    }
                }
            }
        }
        for output in (0..conv.outputs).step_by(V::WIDTH) {
            let count = (conv.outputs - output).min(V::WIDTH);
            // SAFETY: pixels outside of the image are not read.
            unsafe {
                let plane =
                    Plane { start: block.dy, image, size: conv.window.output, channels: conv.outputs };
                let patch = plane.patch::<V, TILE>([row as isize, column as isize], output, count);
                let half = patch.map(|line| of_output(line));
                let strip = output / ROWS * sizes.pixels * ROWS;
                let to = block.left.add(strip + at * ROWS + output % ROWS);
                let step = row_strips * sizes.pixels * ROWS;
                for j in 0..SIZE {
                    for (i, value) in of_output(half.map(|line| line[j])).into_iter().enumerate() {
                        value.store(to.add((i * SIZE + j) * step));
                    }
                }
            }
        }
    }
}

/// Returns `A d`.
#[inline(always)]
unsafe fn of_output<V: Lanes>([a, b, c, d]: [V; TILE]) -> [V; SIZE] {
    // SAFETY: passed on.
    unsafe {
        let (two, four, eight) = (V::splat(2.0), V::splat(4.0), V::splat(8.0));
        let (even, odd) = (a.add(c), b.add(d));
        let (far, apart) = (c.mul_add(four, a), d.mul_add(eight, b.mul(two)));
        [a, even.add(odd), even.sub(odd), far.add(apart), far.sub(apart), d]
    }
}

/// Returns `G^T u`.
#[inline(always)]
unsafe fn of_products<V: Lanes>([a, b, c, d, e, f]: [V; SIZE]) -> [V; TAPS] {
    // SAFETY: passed on.
    unsafe {
        let part = |value: V, divisor: f32| value.mul(V::splat(1.0 / divisor));
        let (sum, difference) = (b.add(c), c.sub(b));
        let (far, apart) = (d.add(e), d.sub(e));
        [
            part(a, 4.0).sub(part(sum, 6.0)).add(part(far, 24.0)),
            part(difference, 6.0).add(part(apart, 12.0)),
            part(far, 6.0).sub(part(sum, 6.0)).add(f),
        ]
    }
}

for_every_isa!(fn dispatch_taps = taps_of_output(sizes: &PixelProducts, sums: &[f32], output: usize, dw: &mut [f32]));

/// Writes `G^T sums G` of all channels of an output.
///
/// # Safety
/// The instruction set is enabled, and the sums have the planes of the sizes.
#[inline(always)]
unsafe fn taps_of_output<V: Lanes>(sizes: &PixelProducts, sums: &[f32], output: usize, dw: &mut [f32]) {
    for (index, dw) in dw.chunks_mut(V::WIDTH * TAPS * TAPS).enumerate() {
        let from = sizes.at(output, index * V::WIDTH);
        let mut lines = [[0.0; MAX_WIDTH]; TAPS * TAPS];
        // SAFETY: columns are filled up to whole registers.
        unsafe {
            let from = sums.as_ptr().add(from);
            let mut half = [[V::splat(0.0); SIZE]; TAPS];
            for j in 0..SIZE {
                let mut column = [V::splat(0.0); SIZE];
                for (i, value) in column.iter_mut().enumerate() {
                    *value = V::load(from.add((i * SIZE + j) * sizes.plane()));
                }
                for (half, value) in half.iter_mut().zip(of_products(column)) {
                    half[j] = value;
                }
            }
            for (half, lines) in half.into_iter().zip(lines.chunks_mut(TAPS)) {
                for (value, line) in of_products(half).into_iter().zip(lines) {
                    value.store(line.as_mut_ptr());
                }
            }
        }
        for (channel, dw) in dw.chunks_mut(TAPS * TAPS).enumerate() {
            dw.iter_mut().zip(&lines).for_each(|(dw, line)| *dw = line[channel]);
        }
    }
}
