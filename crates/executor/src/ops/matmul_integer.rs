//! Products of matrices of bytes, as sums of 32 bits.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_kernels::{
    ByteConvolution, ByteFilters, ByteOutput, ByteWeights, ByteZero, Compute, LayerCost, Window,
};
use opendr_onnx::proto::NodeProto;

use super::inputs::{optional, required};
use super::matmul::Shapes;
use crate::attributes::Attributes;
use crate::constant::Constant;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::Kind;

pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let (a, b) = (required(node, inputs, 0)?, required(node, inputs, 1)?);
    let (a, b) = (planner.plain(a)?, planner.plain(b)?);
    let zeros = [zero(planner, node, inputs, 2, a)?, zero(planner, node, inputs, 3, b)?];
    let Shapes { sizes, left, right, shape } = Shapes::of(node, &planner.shape(a), &planner.shape(b))?;
    let [rows, depth, columns] = sizes;
    let zero_count = |id: Option<Id>| id.map_or(1, |id| planner.shape(id).iter().product::<usize>());
    if ![1, rows].contains(&zero_count(zeros[0])) || ![1, columns].contains(&zero_count(zeros[1])) {
        return Err(node.refused("zero points that are not one for all, or one per row or column"));
    }
    let is_signed = [a, b].map(|id| planner.kind(id) == Kind::I8);
    let per_row = zero_count(zeros[0]) > 1;
    let weights = planner.constant(b).filter(|b| b.shape.len() == 2 && depth > 0 && columns > 0);
    let zero = match zeros[1] {
        Some(id) => planner.constant(id).map(Some),
        None => Some(None),
    };
    if let (Some(weights), Some(zero)) = (weights, zero) {
        let all_rows = planner.shape(a).iter().product::<usize>() / depth;
        let zeros_of_b = zero.as_deref().map_or_else(|| vec![0], numbers);
        let step =
            Packed::new(planner.compute, &weights, &zeros_of_b, [all_rows, rows, depth, columns], is_signed);
        let step = PackedStep { packed: step, per_row, is_signed: is_signed[0] };
        return planner.emit(step, &[Some(a), zeros[0]], &[(Kind::I32, shape, Layout::Plain)]);
    }
    let step = ProductStep {
        left: left.offsets(rows * depth),
        right: right.offsets(depth * columns),
        sizes,
        is_signed,
    };
    planner.emit(step, &[Some(a), Some(b), zeros[0], zeros[1]], &[(Kind::I32, shape, Layout::Plain)])
}

/// Returns the zero point of a value of bytes.
pub(super) fn zero(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
    slot: usize,
    of: Id,
) -> Result<Option<Id>> {
    if !matches!(planner.kind(of), Kind::U8 | Kind::I8) {
        return Err(node.refused("elements that are not bytes"));
    }
    let Some(zero) = optional(inputs, slot) else { return Ok(None) };
    if planner.kind(zero) != planner.kind(of) {
        return Err(node.damaged("a zero point of another type"));
    }
    planner.plain(zero).map(Some)
}

/// Returns the elements of a tensor of bytes.
pub(super) fn numbers(constant: &Constant) -> Vec<i32> {
    let is_signed = constant.kind == Kind::I8;
    constant.numbers::<u8>().iter().map(|&byte| number(byte, is_signed)).collect()
}

/// Returns the number that a byte stands for.
#[inline]
pub(super) fn number(byte: u8, is_signed: bool) -> i32 {
    if is_signed { i32::from(byte as i8) } else { i32::from(byte) }
}

/// Packed weights, for inputs whose zero point a run computes.
struct Packed {
    product: ByteConvolution,
    /// Sums of the weights of each column, which the zero point of the input is multiplied by.
    sums: Vec<i32>,
    rows: usize,
}

impl Packed {
    fn new(
        compute: &Compute,
        weights: &Constant,
        zeros: &[i32],
        [all_rows, rows, depth, columns]: [usize; 4],
        is_signed: [bool; 2],
    ) -> Self {
        let bytes = weights.numbers::<u8>();
        let by_column: Vec<u8> = (0..columns)
            .flat_map(|column| (0..depth).map(move |row| bytes[row * columns + column]))
            .collect();
        let zero = |column: usize| zeros.get(column).or(zeros.first()).copied().unwrap_or(0);
        let sum = |(column, bytes): (usize, &[u8])| -> i32 {
            let numbers = bytes.iter().map(|&byte| number(byte, is_signed[1]) - zero(column));
            numbers.fold(0, i32::wrapping_add)
        };
        let sums = by_column.chunks(depth).enumerate().map(sum).collect();
        let weights = ByteWeights {
            bytes: &by_column,
            is_signed: is_signed[1],
            zeros,
            outputs: columns,
            channels: depth,
            kernel: [1, 1],
            bias: &[],
            scales: &[1.0],
        };
        let input = ByteZero { zero: 0, is_signed: is_signed[0] };
        let filters = Arc::new(ByteFilters::new(compute, &weights, input));
        let (input, output) = ([1, all_rows], ByteOutput::new(input));
        let window =
            Window { kernel: [1, 1], strides: [1, 1], dilations: [1, 1], pads: [0, 0], input, output: input };
        Self { product: ByteConvolution { filters, window, batch: 1, output }, sums, rows }
    }
}

struct PackedStep {
    packed: Packed,
    /// Whether each row has a zero point.
    per_row: bool,
    is_signed: bool,
}

impl Kernel for PackedStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, zeros, y) = (io.read::<u8>(0), io.read::<u8>(1), io.write::<i32>());
        let Packed { product, sums, rows } = &self.packed;
        product.run_to_sums(io.compute, x, y);
        for (row, y) in y.chunks_mut(sums.len()).enumerate() {
            let zero = zeros.get(if self.per_row { row % rows } else { 0 });
            let zero = zero.map_or(0, |&zero| number(zero, self.is_signed));
            if zero != 0 {
                y.iter_mut().zip(sums).for_each(|(y, sum)| *y = y.wrapping_sub(zero.wrapping_mul(*sum)));
            }
        }
        Ok(())
    }

    fn cost(&self) -> LayerCost {
        self.packed.product.cost()
    }
}

struct ProductStep {
    sizes: [usize; 3],
    left: Vec<usize>,
    right: Vec<usize>,
    is_signed: [bool; 2],
}

impl Kernel for ProductStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let [rows, depth, columns] = self.sizes;
        let (a, b) = (io.read::<u8>(0), io.read::<u8>(1));
        let (a_zeros, b_zeros, y) = (io.read::<u8>(2), io.read::<u8>(3), io.write::<i32>());
        let zero = |zeros: &[u8], at: usize, side: usize| {
            zeros.get(at).or(zeros.first()).map_or(0, |&zero| number(zero, self.is_signed[side]))
        };
        let b_zeros: Vec<i32> = (0..columns).map(|column| zero(b_zeros, column, 1)).collect();
        for ((y, &a_at), &b_at) in y.chunks_mut((rows * columns).max(1)).zip(&self.left).zip(&self.right) {
            for (row, y) in y.chunks_mut(columns.max(1)).enumerate() {
                y.fill(0);
                let own_zero = zero(a_zeros, row, 0);
                for (step, &a) in a[a_at + row * depth..][..depth].iter().enumerate() {
                    let a = number(a, self.is_signed[0]) - own_zero;
                    let b = &b[b_at + step * columns..][..columns];
                    for ((y, &b), zero) in y.iter_mut().zip(b).zip(&b_zeros) {
                        *y = y.wrapping_add(a * (number(b, self.is_signed[1]) - zero));
                    }
                }
            }
        }
        Ok(())
    }

    fn cost(&self) -> LayerCost {
        LayerCost::bytes(&self.sizes) * self.left.len()
    }
}
