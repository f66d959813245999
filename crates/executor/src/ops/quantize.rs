//! Quantisation and dequantisation, where no operator computes with the bytes themselves.

use opendr_engine::Result;
use opendr_kernels::{ByteOutput, ByteZero};
use opendr_onnx::proto::NodeProto;

use super::broadcast::Rows;
use super::inputs::{axis, optional, required};
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Planner};
use crate::tensor::Kind;

/// Returns scale and zero point with a shape that broadcasts to the input, and their reach in memory.
fn parameters(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
    x: Id,
) -> Result<(Vec<Option<Id>>, Rows)> {
    let (dims, rank) = (planner.shape(x), planner.rank(x));
    let scale = required(node, inputs, 1)?;
    let zero = optional(inputs, 2);
    let elements: usize = planner.shape(scale).iter().product();
    if node.int_or("block_size", 0) != 0 || planner.kind(scale) != Kind::F32 {
        return Err(node.refused("blocks, or the type of its scale"));
    }
    if zero.is_some_and(|zero| planner.shape(zero).iter().product::<usize>() != elements) {
        return Err(node.damaged("scale and zero point of different shapes"));
    }
    let mut shape = vec![1; rank];
    if elements != 1 || planner.rank(scale) == 1 && rank > 0 && elements > 1 {
        let along = axis(node, node.int_or("axis", 1), rank)?;
        if dims[along] != elements {
            return Err(node.damaged("one scale per element of the axis"));
        }
        shape[along] = elements;
    }
    let value = planner.value(x).clone();
    let physical = value.physical();
    let shape = if planner.is_channels_last(x) { crate::value::channels_to_end(&shape) } else { shape };
    let own = physical.clone();
    let rows = Rows::new(&physical, &[own, shape.clone(), shape]);
    let scale = planner.plain(scale)?;
    let zero = match zero {
        Some(zero) => Some(planner.plain(zero)?),
        None => None,
    };
    Ok((vec![Some(x), Some(scale), zero], rows))
}

pub(crate) fn dequantize(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let from = planner.kind(x);
    if !matches!(from, Kind::U8 | Kind::I8 | Kind::I32)
        || optional(inputs, 2).is_some_and(|zero| planner.kind(zero) != from)
    {
        return Err(node.refused("its types"));
    }
    let (reads, rows) = parameters(planner, node, inputs, x)?;
    let value = planner.value(x).clone();
    planner.emit(DequantizeStep { from, rows }, &reads, &[(Kind::F32, value.shape, value.layout)])
}

pub(crate) fn quantize(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let declared = match node.int_or("output_dtype", 0) {
        0 => None,
        kind => Some(Kind::from_onnx(i32::try_from(kind).unwrap_or(-1), &node.name)?),
    };
    let to = optional(inputs, 2).map(|zero| planner.kind(zero)).or(declared).unwrap_or(Kind::U8);
    if planner.kind(x) != Kind::F32
        || !matches!(to, Kind::U8 | Kind::I8)
        || declared.is_some_and(|declared| declared != to)
    {
        return Err(node.refused("its types"));
    }
    let (reads, rows) = parameters(planner, node, inputs, x)?;
    let value = planner.value(x).clone();
    planner.emit(QuantizeStep { to, rows }, &reads, &[(to, value.shape, value.layout)])
}

/// Quantises to unsigned bytes with a scale and a zero point that a run computes.
pub(super) fn with_scale(planner: &mut Planner<'_>, x: Id, [scale, zero]: [Id; 2]) -> Result<Id> {
    let value = planner.value(x).clone();
    let physical = value.physical();
    let rows = Rows::new(&physical, &[physical.clone(), Vec::new(), Vec::new()]);
    let step = QuantizeStep { to: Kind::U8, rows };
    planner.emit_one(step, &[x, scale, zero], Kind::U8, value.shape, value.layout)
}

struct QuantizeStep {
    to: Kind,
    rows: Rows,
}

impl Kernel for QuantizeStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, scales, zeros) = (io.read::<f32>(0), io.read::<f32>(1), io.read::<u8>(2));
        let y = io.write::<u8>();
        let is_signed = self.to == Kind::I8;
        let output = |index: usize| {
            let zero = zeros
                .get(index)
                .map_or(0, |&zero| if is_signed { i32::from(zero as i8) } else { zero.into() });
            ByteOutput::new(ByteZero { zero, is_signed })
        };
        if let [scale] = scales {
            opendr_kernels::quantize(io.compute, x, *scale, output(0), y);
            return Ok(());
        }
        for (row, y) in y.chunks_mut(self.rows.length.max(1)).enumerate() {
            let x = self.rows.of(x, row, 0, y.len());
            let at = self.rows.start(row, 1);
            if !self.rows.is_row[1] {
                opendr_kernels::quantize(io.compute, x, scales[at], output(at), y);
                continue;
            }
            for (i, (y, x)) in y.chunks_mut(1).zip(x.chunks(1)).enumerate() {
                opendr_kernels::quantize(io.compute, x, scales[at + i], output(at + i), y);
            }
        }
        Ok(())
    }
}

struct DequantizeStep {
    from: Kind,
    rows: Rows,
}

impl Kernel for DequantizeStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let scales = io.read::<f32>(1);
        if let ([scale], Kind::U8 | Kind::I8) = (scales, self.from) {
            let is_signed = self.from == Kind::I8;
            let zero = match io.read::<u8>(2) {
                [zero, ..] if is_signed => i32::from(*zero as i8),
                [zero, ..] => i32::from(*zero),
                [] => 0,
            };
            let x = io.read::<u8>(0);
            opendr_kernels::dequantize(io.compute, x, *scale, ByteZero { zero, is_signed }, io.write());
            return Ok(());
        }
        match self.from {
            Kind::U8 => self.write(io, |x: u8| i32::from(x)),
            Kind::I8 => self.write(io, |x: i8| i32::from(x)),
            _ => self.write(io, |x: i32| x),
        }
        Ok(())
    }
}

impl DequantizeStep {
    fn write<T: opendr_kernels::Number>(&self, io: &mut Io<'_>, read: impl Fn(T) -> i32) {
        let (x, scales, zeros, y) = (io.read::<T>(0), io.read::<f32>(1), io.read::<T>(2), io.write::<f32>());
        for (row, y) in y.chunks_mut(self.rows.length.max(1)).enumerate() {
            let x = self.rows.of(x, row, 0, y.len());
            let at = self.rows.start(row, 1);
            for (i, (y, &x)) in y.iter_mut().zip(x).enumerate() {
                let i = if self.rows.is_row[1] { at + i } else { at };
                let zero = zeros.get(i).map_or(0, |&zero| read(zero));
                *y = read(x).wrapping_sub(zero) as f32 * scales[i];
            }
        }
    }
}
