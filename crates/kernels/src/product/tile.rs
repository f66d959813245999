//! The inner loops: a block of the product, tile by tile, each tile in registers.

use std::mem::MaybeUninit;

use crate::activation::{Activation, apply_all};
use crate::isa::for_every_isa;
use crate::lanes::{Lanes, MAX_WIDTH};

/// Number of registers across a tile.
pub(super) const VECTORS: usize = 2;
/// Steps of the depth per iteration of the loop.
const UNROLLED: usize = 4;
const MAX_ROWS: usize = 8;
const MAX_COLUMNS: usize = VECTORS * MAX_WIDTH;

/// A block of C and its panels of A and B.
#[derive(Clone, Copy)]
pub(super) struct Block {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) depth: usize,
    pub(super) a: *const f32,
    /// Strides of A: to the next row, to the next column, to the next tile. One of the first two is 1.
    pub(super) a_strides: [usize; 3],
    pub(super) b: *const f32,
    /// Strides of B: to the next row, to the next tile. A tile's columns are contiguous.
    pub(super) b_strides: [usize; 2],
    pub(super) c: *mut f32,
    /// Strides of C: to the next row, to the next column.
    pub(super) c_strides: [usize; 2],
    pub(super) finish: Finish,
}

/// Final operation on a sum: `activation(alpha * sum + beta * c + bias)`.
#[derive(Clone, Copy)]
pub(super) struct Finish {
    pub(super) alpha: f32,
    pub(super) beta: f32,
    pub(super) bias: BiasAt,
    pub(super) activation: Activation,
}

/// The bias, from the first row or column of a block on.
#[derive(Clone, Copy)]
pub(super) enum BiasAt {
    None,
    Rows(*const f32),
    Columns(*const f32),
}

for_every_isa!(
    /// Computes a block. The pointers of `block` must be valid for its sizes and strides; B must be readable in whole
    /// tiles.
    pub(super) fn compute_block = block_in_tiles(block: &Block)
);

#[inline(always)]
unsafe fn block_in_tiles<V: Lanes>(block: &Block) {
    let tile_columns = VECTORS * V::WIDTH;
    for first_column in (0..block.columns).step_by(tile_columns) {
        for first_row in (0..block.rows).step_by(V::ROWS) {
            let rows = V::ROWS.min(block.rows - first_row);
            let columns = tile_columns.min(block.columns - first_column);
            // SAFETY: the tile lies in the block, whose pointers are valid by contract.
            unsafe {
                if columns <= V::WIDTH {
                    tile_of_rows::<V, 1>(block, [first_row, first_column], [rows, columns]);
                } else {
                    tile_of_rows::<V, VECTORS>(block, [first_row, first_column], [rows, columns]);
                }
            }
        }
    }
}

#[inline(always)]
unsafe fn tile_of_rows<V: Lanes, const N: usize>(block: &Block, first: [usize; 2], size: [usize; 2]) {
    // SAFETY: passed on.
    unsafe {
        match size[0] {
            1 => tile::<V, 1, N>(block, first, size),
            2 => tile::<V, 2, N>(block, first, size),
            3 => tile::<V, 3, N>(block, first, size),
            4 => tile::<V, 4, N>(block, first, size),
            5 if V::ROWS > 4 => tile::<V, 5, N>(block, first, size),
            6 if V::ROWS > 4 => tile::<V, 6, N>(block, first, size),
            7 if V::ROWS > 6 => tile::<V, 7, N>(block, first, size),
            _ => tile::<V, MAX_ROWS, N>(block, first, size),
        }
    }
}

#[inline(always)]
unsafe fn tile<V: Lanes, const R: usize, const N: usize>(
    block: &Block,
    [first_row, first_column]: [usize; 2],
    size: [usize; 2],
) {
    let [row_stride, column_stride, tile_stride] = block.a_strides;
    // SAFETY: the tile lies in the block. A tile that is incomplete, or whose numbers are not contiguous, is finished
    // in a buffer.
    unsafe {
        let a = block.a.add(first_row / V::ROWS * tile_stride);
        let b = block.b.add(first_column / (VECTORS * V::WIDTH) * block.b_strides[1]);
        let sums = sums::<V, R, N>(block.depth, a, [row_stride, column_stride], b, block.b_strides[0]);
        let c = block.c.add(first_row * block.c_strides[0] + first_column * block.c_strides[1]);
        let bias = match block.finish.bias {
            BiasAt::None => BiasAt::None,
            BiasAt::Rows(bias) => BiasAt::Rows(bias.add(first_row)),
            BiasAt::Columns(bias) => BiasAt::Columns(bias.add(first_column)),
        };
        let finish = Finish { bias, ..block.finish };
        if size[1] == N * V::WIDTH && block.c_strides[1] == 1 {
            finish_tile::<V, R, N>(sums, c, block.c_strides[0], &finish);
        } else {
            finish_aside::<V, R, N>(sums, c, block.c_strides, size, &finish);
        }
    }
}

/// Sums the products over the depth, from the first to the last, each element separately: the order, and with it
/// every bit, does not depend on the division of the work.
#[inline(always)]
unsafe fn sums<V: Lanes, const R: usize, const N: usize>(
    depth: usize,
    mut a: *const f32,
    [row_stride, column_stride]: [usize; 2],
    mut b: *const f32,
    b_stride: usize,
) -> [[V; N]; R] {
    // SAFETY: by the contract of `compute_block`; pointers move past the end only after the last use.
    unsafe {
        let mut sums = [[V::splat(0.0); N]; R];
        if row_stride == 1 {
            for _ in 0..depth / UNROLLED {
                for _ in 0..UNROLLED {
                    add_step(&mut sums, std::array::from_fn(|i| a.add(i)), b);
                    (a, b) = (a.wrapping_add(column_stride), b.wrapping_add(b_stride));
                }
            }
            for _ in 0..depth % UNROLLED {
                add_step(&mut sums, std::array::from_fn(|i| a.add(i)), b);
                (a, b) = (a.wrapping_add(column_stride), b.wrapping_add(b_stride));
            }
            return sums;
        }
        let mut rows: [*const f32; R] = std::array::from_fn(|i| a.add(i * row_stride));
        for _ in 0..depth / UNROLLED {
            for step in 0..UNROLLED {
                add_step(&mut sums, rows.map(|row| row.add(step)), b);
                b = b.wrapping_add(b_stride);
            }
            rows = rows.map(|row| row.wrapping_add(UNROLLED));
        }
        for step in 0..depth % UNROLLED {
            add_step(&mut sums, rows.map(|row| row.add(step)), b);
            b = b.wrapping_add(b_stride);
        }
        sums
    }
}

/// Adds the products of one number per row and a row of registers.
#[inline(always)]
unsafe fn add_step<V: Lanes, const R: usize, const N: usize>(
    sums: &mut [[V; N]; R],
    left: [*const f32; R],
    right: *const f32,
) {
    // SAFETY: by the contract of `compute_block`.
    unsafe {
        let mut vectors = [V::splat(0.0); N];
        for (j, vector) in vectors.iter_mut().enumerate() {
            *vector = V::load(right.add(j * V::WIDTH));
        }
        for (row, left) in sums.iter_mut().zip(left) {
            let left = V::splat(*left);
            for (sum, &vector) in row.iter_mut().zip(&vectors) {
                *sum = left.mul_add(vector, *sum);
            }
        }
    }
}

#[inline(always)]
unsafe fn finish_tile<V: Lanes, const R: usize, const N: usize>(
    mut sums: [[V; N]; R],
    c: *mut f32,
    row_stride: usize,
    finish: &Finish,
) {
    // SAFETY: `c` has R rows of N registers, a bias of rows R numbers, a bias of columns N registers.
    unsafe {
        if finish.alpha != 1.0 {
            change(&mut sums, |_, _, sum| sum.mul(V::splat(finish.alpha)));
        }
        if finish.beta != 0.0 {
            let before = |i, j| V::load(c.add(i * row_stride + j * V::WIDTH));
            change(&mut sums, |i, j, sum| before(i, j).mul_add(V::splat(finish.beta), sum));
        }
        match finish.bias {
            BiasAt::None => (),
            BiasAt::Rows(bias) => change(&mut sums, |i, _, sum| sum.add(V::splat(*bias.add(i)))),
            BiasAt::Columns(bias) => {
                change(&mut sums, |_, j, sum| sum.add(V::load(bias.add(j * V::WIDTH))));
            }
        }
        if finish.activation == Activation::Relu {
            change(&mut sums, |_, _, sum| Activation::Relu.of(sum));
        }
        for (i, row) in sums.iter().enumerate() {
            for (j, sum) in row.iter().enumerate() {
                sum.store(c.add(i * row_stride + j * V::WIDTH));
            }
        }
        // Long functions are inlined once for all registers of a row, not for each.
        if !matches!(finish.activation, Activation::Identity | Activation::Relu) {
            for i in 0..R {
                apply_all::<V>(finish.activation, c.add(i * row_stride), N * V::WIDTH);
            }
        }
    }
}

#[inline(always)]
fn change<V: Copy, const R: usize, const N: usize>(
    sums: &mut [[V; N]; R],
    to: impl Fn(usize, usize, V) -> V,
) {
    for (i, row) in sums.iter_mut().enumerate() {
        for (j, sum) in row.iter_mut().enumerate() {
            *sum = to(i, j, *sum);
        }
    }
}

/// Finishes a tile in a buffer of whole registers: gathers the existing values, then scatters the result.
#[inline(always)]
pub(super) unsafe fn finish_aside<V: Lanes, const R: usize, const N: usize>(
    sums: [[V; N]; R],
    c: *mut f32,
    [row_stride, column_stride]: [usize; 2],
    [rows, columns]: [usize; 2],
    finish: &Finish,
) {
    let mut tile = MaybeUninit::<[f32; MAX_ROWS * MAX_COLUMNS]>::uninit();
    let tile = tile.as_mut_ptr().cast::<f32>();
    let mut column_bias = [0.0; MAX_COLUMNS];
    let width = N * V::WIDTH;
    // SAFETY: only the first `rows` and `columns` of `c` and of the bias are touched; the buffers are large enough,
    // and the tile is written before it is read.
    unsafe {
        let mut bias = finish.bias;
        if let BiasAt::Columns(from) = bias {
            column_bias.as_mut_ptr().copy_from_nonoverlapping(from, columns);
            bias = BiasAt::Columns(column_bias.as_ptr());
        }
        if finish.beta != 0.0 {
            tile.write_bytes(0, R * width);
            for i in 0..rows {
                for j in 0..columns {
                    *tile.add(i * width + j) = *c.add(i * row_stride + j * column_stride);
                }
            }
        }
        finish_tile::<V, R, N>(sums, tile, width, &Finish { bias, ..*finish });
        for i in 0..rows {
            for j in 0..columns {
                *c.add(i * row_stride + j * column_stride) = *tile.add(i * width + j);
            }
        }
    }
}
