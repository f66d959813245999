//! Normalisations over rows: instance, group, root mean square, and Lp.

use opendr_engine::Result;
use opendr_kernels::Binary;
use opendr_onnx::proto::NodeProto;

use super::elementwise::{Function, combine};
use super::inputs::{axis, required};
use super::normalise::{squares, sum};
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::Kind;

/// What a row is divided by.
#[derive(Debug, Clone, Copy)]
enum Norm {
    /// The standard deviation, after the mean has been subtracted.
    Deviation,
    /// The root mean square.
    RootMeanSquare,
    /// The sum of absolute values.
    Absolute,
    /// The root of the sum of squares.
    Euclidean,
}

/// Divides rows of the last elements by a norm.
struct NormStep {
    norm: Norm,
    length: usize,
    epsilon: f32,
}

impl Kernel for NormStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, y) = (io.read::<f32>(0), io.write::<f32>());
        let length = self.length.max(1);
        let isa = io.compute.isa();
        let rows = ((1 << 13) / length).max(1);
        io.compute.pool().run_on_pieces(y, rows * length, |index, y| {
            let x = &x[index * rows * length..][..y.len()];
            for (y, x) in y.chunks_mut(length).zip(x.chunks(length)) {
                let mean_of_squares = |x: &[f32]| 1.0 / (squares(x) / length as f32 + self.epsilon).sqrt();
                // A row of zeros stays zero.
                let inverse = |norm: f32| if norm == 0.0 { 0.0 } else { 1.0 / norm };
                let factor = match self.norm {
                    Norm::Deviation => {
                        let mean = sum(x) / length as f32;
                        y.iter_mut().zip(x).for_each(|(y, x)| *y = x - mean);
                        let factor = mean_of_squares(y);
                        Binary::Mul.apply_scalar(isa, y, factor);
                        continue;
                    }
                    Norm::RootMeanSquare => mean_of_squares(x),
                    Norm::Absolute => inverse(x.iter().map(|x| x.abs()).sum()),
                    Norm::Euclidean => inverse(squares(x).sqrt()),
                };
                y.iter_mut().zip(x).for_each(|(y, x)| *y = x * factor);
            }
        });
        Ok(())
    }
}

fn floats(planner: &mut Planner<'_>, node: &NodeProto, id: Id) -> Result<Id> {
    if planner.kind(id) != Kind::F32 {
        return Err(node.refused(&format!("elements of type {:?}", planner.kind(id))));
    }
    planner.plain(id)
}

fn norm(planner: &mut Planner<'_>, x: Id, norm: Norm, length: usize, epsilon: f32) -> Result<Id> {
    let shape = planner.shape(x);
    planner.emit_one(NormStep { norm, length, epsilon }, &[x], Kind::F32, shape, Layout::Plain)
}

/// Instance and group normalisation: each group of channels of an image has mean 0 and deviation 1, before scale and bias of a channel.
pub(crate) fn group(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let x = floats(planner, node, x)?;
    let dims = planner.shape(x);
    let Some(channels) = dims.get(1).copied().filter(|&channels| channels > 0) else {
        return Err(node.damaged("an input without channels"));
    };
    let groups = match node.op_type.as_str() {
        "InstanceNormalization" => channels,
        _ => usize::try_from(node.int_or("num_groups", 0)).unwrap_or(0),
    };
    if groups == 0 || channels % groups != 0 {
        return Err(node.damaged(&format!("{groups} groups of {channels} channels")));
    }
    let length = channels / groups * dims[2..].iter().product::<usize>();
    let mut y = norm(planner, x, Norm::Deviation, length, node.float("epsilon", 1e-5))?;
    for (slot, function) in [(1, Function::Mul), (2, Function::Add)] {
        let parameter = required(node, inputs, slot)?;
        let parameter = floats(planner, node, parameter)?;
        let count = planner.shape(parameter).iter().product::<usize>();
        // Up to opset 20 one parameter per group.
        let wide = match count {
            count if count == channels => {
                let mut shape = vec![1; dims.len() - 1];
                shape[0] = channels;
                planner.alias(parameter, shape, Layout::Plain)
            }
            count if count == groups => {
                let rows = vec![dims[0], groups, length];
                y = planner.alias(y, rows, Layout::Plain);
                planner.alias(parameter, vec![groups, 1], Layout::Plain)
            }
            _ => return Err(node.damaged("its scale or bias")),
        };
        y = combine(planner, node, function, y, wide)?;
        y = planner.plain(y)?;
        y = planner.alias(y, dims.clone(), Layout::Plain);
    }
    Ok(vec![y])
}

/// Divides by the root mean square of the dimensions from the axis on.
pub(crate) fn root_mean_square(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let (x, scale) = (required(node, inputs, 0)?, required(node, inputs, 1)?);
    let x = floats(planner, node, x)?;
    let dims = planner.shape(x);
    let along = axis(node, node.int_or("axis", -1), dims.len())?;
    let length = dims[along..].iter().product();
    let y = norm(planner, x, Norm::RootMeanSquare, length, node.float("epsilon", 1e-5))?;
    Ok(vec![combine(planner, node, Function::Mul, y, scale)?])
}

/// Divides by the norm along an axis.
pub(crate) fn lp(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let x = floats(planner, node, x)?;
    let dims = planner.shape(x);
    let along = axis(node, node.int_or("axis", -1), dims.len())?;
    let by = match node.int_or("p", 2) {
        1 => Norm::Absolute,
        2 => Norm::Euclidean,
        other => return Err(node.refused(&format!("a norm of order {other}"))),
    };
    let mut order: Vec<usize> = (0..dims.len()).collect();
    order.swap(along, dims.len() - 1);
    let swapped: Vec<usize> = order.iter().map(|&d| dims[d]).collect();
    let there = crate::remap::transposed(&dims, &order, 4);
    let moved = planner.emit_one(there, &[x], Kind::F32, swapped.clone(), Layout::Plain)?;
    let y = norm(planner, moved, by, dims[along], 0.0)?;
    let back = crate::remap::transposed(&swapped, &order, 4);
    Ok(vec![planner.emit_one(back, &[y], Kind::F32, dims, Layout::Plain)?])
}
