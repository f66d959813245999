//! Softmax and normalisations.

use opendr_engine::Result;
use opendr_kernels::Binary;
use opendr_onnx::proto::NodeProto;

use super::elementwise::{Function, combine};
use super::inputs::{axis, optional, required};
use crate::attributes::Attributes;
use crate::constant::Constant;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::Kind;

pub(crate) fn softmax(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let dims = planner.shape(x);
    if planner.kind(x) != Kind::F32 {
        return Err(node.refused("elements that are not floats"));
    }
    let flat = planner.graph.opset < 13;
    let along = axis(node, node.int_or("axis", if flat { 1 } else { -1 }), dims.len().max(1))?;
    let is_log = node.op_type == "LogSoftmax";
    if dims.is_empty() {
        return Err(node.refused("a scalar"));
    }
    // Up to opset 12 all dimensions from the axis on are one.
    if flat || along + 1 == dims.len() {
        let x = planner.plain(x)?;
        let length = if flat { dims[along..].iter().product() } else { dims[along] };
        return Ok(vec![planner.emit_one(
            SoftmaxStep { length, is_log },
            &[x],
            Kind::F32,
            dims,
            Layout::Plain,
        )?]);
    }
    if along == 1 && planner.is_channels_last(x) {
        let step = SoftmaxStep { length: dims[1], is_log };
        return Ok(vec![planner.emit_one(step, &[x], Kind::F32, dims, Layout::ChannelsLast)?]);
    }
    let x = planner.plain(x)?;
    let mut order: Vec<usize> = (0..dims.len()).collect();
    order.swap(along, dims.len() - 1);
    let swapped: Vec<usize> = order.iter().map(|&d| dims[d]).collect();
    let there = crate::remap::transposed(&dims, &order, 4);
    let moved = planner.emit_one(there, &[x], Kind::F32, swapped.clone(), Layout::Plain)?;
    let step = SoftmaxStep { length: dims[along], is_log };
    let y = planner.emit_one(step, &[moved], Kind::F32, swapped.clone(), Layout::Plain)?;
    let back = crate::remap::transposed(&swapped, &order, 4);
    Ok(vec![planner.emit_one(back, &[y], Kind::F32, dims, Layout::Plain)?])
}

struct SoftmaxStep {
    length: usize,
    is_log: bool,
}

impl Kernel for SoftmaxStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, y) = (io.read::<f32>(0), io.write::<f32>());
        let length = self.length.max(1);
        if y.is_empty() {
            return Ok(());
        }
        let isa = io.compute.isa();
        let rows = ((1 << 13) / length).max(1);
        io.compute.pool().run_on_pieces(y, rows * length, |index, y| {
            let x = &x[index * rows * length..][..y.len()];
            for (y, x) in y.chunks_mut(length).zip(x.chunks(length)) {
                let largest = x.iter().copied().fold(f32::NEG_INFINITY, f32::max);
                // A row of minus infinities has no maximum to subtract.
                let largest = if largest.is_finite() { largest } else { 0.0 };
                y.iter_mut().zip(x).for_each(|(y, x)| *y = x - largest);
            }
            if self.is_log {
                for y in y.chunks_mut(length) {
                    let sum: f32 = y.iter().map(|y| y.exp()).sum();
                    Binary::Sub.apply_scalar(isa, y, sum.ln());
                }
                return;
            }
            // All rows at once: short ones would leave registers empty.
            opendr_kernels::exp_in_place(isa, y);
            for y in y.chunks_mut(length) {
                let scale = 1.0 / y.iter().sum::<f32>();
                y.iter_mut().for_each(|y| *y *= scale);
            }
        });
        Ok(())
    }
}

pub(crate) fn batch(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let dims = planner.shape(x);
    if node.int_or("training_mode", 0) != 0 || dims.len() < 2 {
        return Err(node.refused("training mode, or its input"));
    }
    let mut parameters = Vec::new();
    for slot in 1..5 {
        let constant = planner.known(node, required(node, inputs, slot)?)?;
        if constant.shape != [dims[1]] {
            return Err(node.damaged("parameters that are not one per channel"));
        }
        parameters
            .push(constant.floats().ok_or_else(|| node.refused("parameters that are not floats"))?.to_vec());
    }
    let epsilon = node.float("epsilon", 1e-5);
    let scale: Vec<f32> =
        (0..dims[1]).map(|c| parameters[0][c] / (parameters[3][c] + epsilon).sqrt()).collect();
    let shift: Vec<f32> = (0..dims[1]).map(|c| parameters[1][c] - parameters[2][c] * scale[c]).collect();
    let mut shape = vec![1; dims.len() - 1];
    shape[0] = dims[1];
    let scale = planner.add_constant(Constant::from_floats(shape.clone(), &scale));
    let shift = planner.add_constant(Constant::from_floats(shape, &shift));
    let scaled = combine(planner, node, Function::Mul, x, scale)?;
    Ok(vec![combine(planner, node, Function::Add, scaled, shift)?])
}

pub(crate) fn layer(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let x = planner.plain(x)?;
    let dims = planner.shape(x);
    let along = axis(node, node.int_or("axis", -1), dims.len())?;
    let length = dims[along..].iter().product();
    let scale = required(node, inputs, 1)?;
    let scale = planner.plain(scale)?;
    let bias = match optional(inputs, 2) {
        Some(bias) => Some(planner.plain(bias)?),
        None => None,
    };
    let fits =
        |id: Id| planner.shape(id).iter().product::<usize>() == length && planner.kind(id) == Kind::F32;
    if !fits(scale) || !bias.is_none_or(fits) || planner.kind(x) != Kind::F32 {
        return Err(node.refused("its scale or bias"));
    }
    let step = LayerStep { length, epsilon: node.float("epsilon", 1e-5) };
    planner.emit(step, &[Some(x), Some(scale), bias], &[(Kind::F32, dims, Layout::Plain)])
}

struct LayerStep {
    length: usize,
    epsilon: f32,
}

impl Kernel for LayerStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, scale, bias, y) =
            (io.read::<f32>(0), io.read::<f32>(1), io.read::<f32>(2), io.write::<f32>());
        let length = self.length.max(1);
        if y.is_empty() {
            return Ok(());
        }
        let isa = io.compute.isa();
        let rows = ((1 << 13) / length).max(1);
        io.compute.pool().run_on_pieces(y, rows * length, |index, y| {
            let x = &x[index * rows * length..][..y.len()];
            for (y, x) in y.chunks_mut(length).zip(x.chunks(length)) {
                let mean = sum(x) / length as f32;
                y.iter_mut().zip(x).for_each(|(y, x)| *y = x - mean);
                let variance = squares(y) / length as f32;
                Binary::Mul.apply_scalar(isa, y, 1.0 / (variance + self.epsilon).sqrt());
                Binary::Mul.apply_to(isa, y, scale);
                if !bias.is_empty() {
                    Binary::Add.apply_to(isa, y, bias);
                }
            }
        });
        Ok(())
    }
}

/// Sums in sixteen lanes, which the compiler keeps in registers.
pub(crate) fn sum(x: &[f32]) -> f32 {
    let (chunks, rest) = x.as_chunks::<16>();
    let mut lanes = [0.0_f32; 16];
    for chunk in chunks {
        lanes.iter_mut().zip(chunk).for_each(|(lane, x)| *lane += x);
    }
    lanes.iter().sum::<f32>() + rest.iter().sum::<f32>()
}

pub(crate) fn squares(x: &[f32]) -> f32 {
    let (chunks, rest) = x.as_chunks::<16>();
    let mut lanes = [0.0_f32; 16];
    for chunk in chunks {
        lanes.iter_mut().zip(chunk).for_each(|(lane, x)| *lane += x * x);
    }
    lanes.iter().sum::<f32>() + rest.iter().map(|x| x * x).sum::<f32>()
}
