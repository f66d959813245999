//! Products of few columns: each element is a dot product, with registers along the depth.

use super::tile::{BiasAt, Block, Finish, finish_aside};
use crate::isa::for_every_isa;
use crate::lanes::{Lanes, MAX_WIDTH};

/// Maximum number of columns; with more, tiles are faster.
pub(super) const MOST_COLUMNS: usize = 4;

for_every_isa!(
    /// Computes a block of at most [`MOST_COLUMNS`]. The pointers of `block` must be valid for its sizes and strides;
    /// rows of A and columns of B must be contiguous.
    pub(super) fn compute_dots = dots_of_columns(block: &Block)
);

#[inline(always)]
unsafe fn dots_of_columns<V: Lanes>(block: &Block) {
    // SAFETY: passed on.
    unsafe {
        match block.columns {
            1 => dots_of_rows::<V, 4, 1>(block),
            2 => dots_of_rows::<V, 4, 2>(block),
            3 => dots_of_rows::<V, 2, 3>(block),
            _ => dots_of_rows::<V, 2, MOST_COLUMNS>(block),
        }
    }
}

/// Computes R rows at a time, then single rows.
#[inline(always)]
unsafe fn dots_of_rows<V: Lanes, const R: usize, const N: usize>(block: &Block) {
    let whole = block.rows / R * R;
    // SAFETY: passed on, for rows of the block.
    unsafe {
        for first in (0..whole).step_by(R) {
            dots::<V, R, N>(block, first);
        }
        for first in whole..block.rows {
            dots::<V, 1, N>(block, first);
        }
    }
}

#[inline(always)]
unsafe fn dots<V: Lanes, const R: usize, const N: usize>(block: &Block, first: usize) {
    let (depth, whole) = (block.depth, block.depth / V::WIDTH * V::WIDTH);
    // SAFETY: the rows lie in the block; whole registers lie within the depth, the rest is counted.
    unsafe {
        let a: [*const f32; R] = std::array::from_fn(|i| block.a.add((first + i) * block.a_strides[0]));
        let b: [*const f32; N] = std::array::from_fn(|j| block.b.add(j * block.b_strides[1]));
        let mut sums = [[V::splat(0.0); N]; R];
        for step in (0..whole).step_by(V::WIDTH) {
            add_products(&mut sums, a, b, step, V::WIDTH);
        }
        if whole < depth {
            add_products(&mut sums, a, b, whole, depth - whole);
        }
        let c = block.c.add(first * block.c_strides[0]);
        let bias = match block.finish.bias {
            BiasAt::Rows(bias) => BiasAt::Rows(bias.add(first)),
            other => other,
        };
        let finish = Finish { bias, ..block.finish };
        finish_aside::<V, R, 1>(totals(&sums), c, block.c_strides, [R, N], &finish);
    }
}

/// Adds the products of `count` steps of the depth, at most a register.
#[inline(always)]
unsafe fn add_products<V: Lanes, const R: usize, const N: usize>(
    sums: &mut [[V; N]; R],
    a: [*const f32; R],
    b: [*const f32; N],
    step: usize,
    count: usize,
) {
    // SAFETY: by the contract of `compute_dots`.
    unsafe {
        let load = |from: *const f32| match count == V::WIDTH {
            true => V::load(from.add(step)),
            false => V::load_some(from.add(step), count),
        };
        let mut right = [V::splat(0.0); N];
        for (register, from) in right.iter_mut().zip(b) {
            *register = load(from);
        }
        for (row, from) in sums.iter_mut().zip(a) {
            let left = load(from);
            for (sum, &right) in row.iter_mut().zip(&right) {
                *sum = left.mul_add(right, *sum);
            }
        }
    }
}

/// Adds the lanes of each register in order; returns the totals of a row side by side.
#[inline(always)]
unsafe fn totals<V: Lanes, const R: usize, const N: usize>(sums: &[[V; N]; R]) -> [[V; 1]; R] {
    // SAFETY: no register has more than `MAX_WIDTH` numbers.
    unsafe {
        let mut rows = [[V::splat(0.0)]; R];
        for (row, sums) in rows.iter_mut().zip(sums) {
            let (mut totals, mut lanes) = ([0.0; MAX_WIDTH], [0.0; MAX_WIDTH]);
            for (total, sum) in totals.iter_mut().zip(sums) {
                sum.store(lanes.as_mut_ptr());
                *total = lanes[..V::WIDTH].iter().sum();
            }
            *row = [V::load(totals.as_ptr())];
        }
        rows
    }
}
