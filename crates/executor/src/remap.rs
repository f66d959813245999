//! Copies that order, repeat or select elements: transposes, slices, expansion.

use opendr_engine::Result;
use opendr_kernels::{Compute, Number};

use crate::io::{Io, Kernel};

/// Where the elements along a dimension of the output come from.
#[derive(Debug, Clone)]
pub(crate) enum Axis {
    Strided { length: usize, stride: usize },
    Table(Vec<usize>),
}

impl Axis {
    fn length(&self) -> usize {
        match self {
            Self::Strided { length, .. } => *length,
            Self::Table(table) => table.len(),
        }
    }

    fn offset(&self, index: usize) -> usize {
        match self {
            Self::Strided { stride, .. } => index * stride,
            Self::Table(table) => table[index],
        }
    }
}

/// Copies elements: each dimension of the output reads along one of the input.
pub(crate) struct Remap {
    axes: Vec<Axis>,
    size: usize,
}

impl Remap {
    /// Creates the copy from the offsets in the input of each index of each dimension of the output.
    pub(crate) fn new(axes: Vec<Axis>, size: usize) -> Self {
        let mut merged: Vec<Axis> = Vec::new();
        for axis in axes.into_iter().filter(|axis| !matches!(axis, Axis::Strided { length: 1, .. })) {
            match (merged.last_mut(), &axis) {
                (Some(Axis::Strided { length, stride }), Axis::Strided { length: inner, stride: step })
                    if *stride == inner * step =>
                {
                    (*length, *stride) = (*length * inner, *step);
                }
                _ => merged.push(axis),
            }
        }
        if merged.is_empty() {
            merged.push(Axis::Strided { length: 1, stride: 1 });
        }
        Self { axes: merged, size }
    }

    fn copy<T: Number>(&self, compute: &Compute, x: &[T], y: &mut [T]) {
        let [outer @ .., last] = self.axes.as_slice() else { return };
        let length = last.length();
        if length == 0 || y.is_empty() {
            return;
        }
        if let ([outer @ .., Axis::Strided { length: rows, stride: 1 }], Axis::Strided { stride, .. }) =
            (outer, last)
            && *stride != 1
        {
            return transpose_blocks(compute, outer, [*rows, length, *stride], x, y);
        }
        let rows_per_piece = ((1 << 14) / length).max(1);
        compute.pool().run_on_pieces(y, rows_per_piece * length, |piece, y| {
            for (row, y) in y.chunks_mut(length).enumerate() {
                let from = offset(outer, piece * rows_per_piece + row);
                match last {
                    Axis::Strided { stride: 1, .. } => y.copy_from_slice(&x[from..from + length]),
                    Axis::Strided { stride: 0, .. } => y.fill(x[from]),
                    Axis::Strided { stride, .. } => {
                        y.iter_mut().zip(x[from..].iter().step_by(*stride)).for_each(|(y, x)| *y = *x);
                    }
                    Axis::Table(table) => y.iter_mut().zip(table).for_each(|(y, at)| *y = x[from + at]),
                }
            }
        });
    }
}

/// Returns the offset of a row in the input.
fn offset(outer: &[Axis], mut row: usize) -> usize {
    let mut from = 0;
    for axis in outer.iter().rev() {
        let length = axis.length().max(1);
        from += axis.offset(row % length);
        row /= length;
    }
    from
}

/// Transposes matrices block by block, so that lines of both stay in the cache.
fn transpose_blocks<T: Number>(
    compute: &Compute,
    outer: &[Axis],
    [rows, columns, stride]: [usize; 3],
    x: &[T],
    y: &mut [T],
) {
    const BLOCK: usize = 16;
    let rows_per_piece = ((1 << 14) / columns).clamp(1, rows).next_multiple_of(BLOCK).min(rows);
    for (image, y) in y.chunks_mut(rows * columns).enumerate() {
        let x = &x[offset(outer, image)..];
        compute.pool().run_on_pieces(y, rows_per_piece * columns, |piece, y| {
            let first = piece * rows_per_piece;
            let rows = y.len() / columns;
            for row in (0..rows).step_by(BLOCK) {
                for column in (0..columns).step_by(BLOCK) {
                    let width = BLOCK.min(columns - column);
                    for i in row..(row + BLOCK).min(rows) {
                        let y = &mut y[i * columns + column..][..width];
                        for (j, y) in y.iter_mut().enumerate() {
                            *y = x[first + i + (column + j) * stride];
                        }
                    }
                }
            }
        });
    }
}

/// Calls a generic function with the type of elements of that many bytes.
macro_rules! by_size {
    ($size:expr, $type:ident => $call:expr) => {
        match $size {
            8 => {
                type $type = u64;
                $call
            }
            4 => {
                type $type = u32;
                $call
            }
            2 => {
                type $type = u16;
                $call
            }
            _ => {
                type $type = u8;
                $call
            }
        }
    };
}
pub(crate) use by_size;

impl Kernel for Remap {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        by_size!(self.size, T => {
            let x = io.read::<T>(0);
            self.copy(io.compute, x, io.write::<T>());
        });
        Ok(())
    }
}

/// Returns the strides of a tensor in row-major order.
pub(crate) fn strides(dims: &[usize]) -> Vec<usize> {
    let mut strides = vec![1; dims.len()];
    for i in (1..dims.len()).rev() {
        strides[i - 1] = strides[i] * dims[i];
    }
    strides
}

/// Returns the copy that orders dimensions anew.
pub(crate) fn transposed(dims: &[usize], order: &[usize], size: usize) -> Remap {
    let strides = strides(dims);
    Remap::new(order.iter().map(|&d| Axis::Strided { length: dims[d], stride: strides[d] }).collect(), size)
}
