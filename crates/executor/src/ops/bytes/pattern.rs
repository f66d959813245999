//! Quantised inputs and outputs of a node.

use opendr_kernels::{ByteOutput, ByteZero};
use opendr_onnx::proto::NodeProto;

use super::super::elementwise::clip_of;
use crate::constant::Constant;
use crate::planner::{Id, Planner};
use crate::tensor::Kind;

/// A dequantised tensor with one scale.
#[derive(Debug, Clone, Copy)]
pub(super) struct Dequantised {
    pub(super) bytes: Id,
    pub(super) scale: f32,
    pub(super) zero: ByteZero,
}

/// Returns what an input of bytes with one constant scale and zero point is made of.
pub(super) fn dequantised(planner: &Planner<'_>, name: &str) -> Option<Dequantised> {
    let node = planner.deferred(name)?;
    let bytes = planner.named(node.input.first()?)?;
    let (scale, zero) = scale_and_zero(planner, node, planner.kind(bytes))?;
    Some(Dequantised { bytes, scale, zero })
}

/// Returns one constant scale, and the zero point of that type.
pub(super) fn scale_and_zero(planner: &Planner<'_>, node: &NodeProto, kind: Kind) -> Option<(f32, ByteZero)> {
    let is_signed = match kind {
        Kind::U8 => false,
        Kind::I8 => true,
        _ => return None,
    };
    let scale = planner.scalar(planner.named(node.input.get(1)?)?)?;
    let zero = match node.input.get(2).filter(|name| !name.is_empty()) {
        Some(name) => {
            let constant = planner.constant(planner.named(name)?)?;
            if constant.kind != kind {
                return None;
            }
            match integers(&constant)?.as_slice() {
                [zero] => *zero,
                _ => return None,
            }
        }
        None => 0,
    };
    let is_plain = node.int_or("block_size", 0) == 0 && scale.is_finite() && scale > 0.0;
    is_plain.then_some((scale, ByteZero { zero, is_signed }))
}

/// Returns the elements of a constant of bytes or 32-bit integers.
pub(super) fn integers(constant: &Constant) -> Option<Vec<i32>> {
    let region = constant.region();
    Some(match constant.kind {
        Kind::U8 => constant.data.get::<u8>(region).iter().map(|&byte| i32::from(byte)).collect(),
        Kind::I8 => constant.data.get::<i8>(region).iter().map(|&byte| i32::from(byte)).collect(),
        Kind::I32 => constant.data.get::<i32>(region).to_vec(),
        _ => return None,
    })
}

/// The quantisation of the output of a node, after at most some activations that are bounds.
#[derive(Debug)]
pub(super) struct Requantised {
    pub(super) scale: f32,
    pub(super) output: ByteOutput,
    nodes: Vec<usize>,
}

impl Requantised {
    pub(super) fn kind(&self) -> Kind {
        if self.output.zero.is_signed { Kind::I8 } else { Kind::U8 }
    }

    /// States that `y` is the quantised output.
    pub(super) fn absorb(&self, planner: &mut Planner<'_>, y: Id) {
        for (index, &node) in self.nodes.iter().enumerate() {
            let last = index + 1 == self.nodes.len();
            planner.absorb(node, last.then_some(y));
        }
    }
}

/// Returns how the output of a node is quantised, where nothing else reads it.
pub(super) fn requantised(planner: &Planner<'_>, node: &NodeProto) -> Option<Requantised> {
    let mut name = node.output.first()?;
    let mut bounds = [f32::NEG_INFINITY, f32::INFINITY];
    let mut nodes = Vec::new();
    loop {
        let index = planner.graph.only_reader(name).filter(|&index| !planner.is_fused(index))?;
        let next = &planner.graph.nodes[index];
        if next.output.len() != 1 || next.input.first() != Some(name) {
            return None;
        }
        nodes.push(index);
        match next.op_type.as_str() {
            "QuantizeLinear" => {
                let (scale, output) = quantisation(planner, next, bounds)?;
                return Some(Requantised { scale, output, nodes });
            }
            "Relu" => bounds = bounds.map(|bound| bound.max(0.0)),
            "Clip" => {
                let inputs: Vec<Option<Id>> = next.input.iter().map(|name| planner.named(name)).collect();
                let known =
                    next.input.iter().zip(&inputs).skip(1).all(|(name, id)| name.is_empty() || id.is_some());
                let Some(opendr_kernels::Unary::Clip { low, high }) =
                    clip_of(planner, next, &inputs).filter(|_| known)
                else {
                    return None;
                };
                bounds = bounds.map(|bound| bound.max(low).min(high));
            }
            _ => return None,
        }
        name = next.output.first()?;
    }
}

/// Returns scale and quantisation of a node, whose input lies within bounds.
pub(super) fn quantisation(
    planner: &Planner<'_>,
    node: &NodeProto,
    bounds: [f32; 2],
) -> Option<(f32, ByteOutput)> {
    let kind = match node.input.get(2).filter(|name| !name.is_empty()) {
        Some(name) => planner.kind(planner.named(name)?),
        None => Kind::U8,
    };
    let declared = node.int_or("output_dtype", 0);
    if declared != 0 && declared != if kind == Kind::I8 { 3 } else { 2 } {
        return None;
    }
    let (scale, zero) = scale_and_zero(planner, node, kind)?;
    let all = ByteOutput::new(zero);
    // Rounding is monotone: bounds of the numbers are bounds of the bytes.
    let byte = |bound: f32| {
        let rounded = (bound / scale).round_ties_even() as i32;
        rounded.saturating_add(zero.zero).clamp(all.low, all.high)
    };
    Some((scale, ByteOutput { zero, low: byte(bounds[0]), high: byte(bounds[1]) }))
}
