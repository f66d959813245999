//! Elements by index.

use opendr_engine::{Error, Result};

use super::shape::fill_shape;
use crate::tensorflow::call::{Call, axis_in};
use crate::tensorflow::layout::Order;
use crate::tensorflow::lowering::Lowering;
use crate::tensorflow::value::Value;
use opendr_onnx::{Array, Dim, ElementType, GraphTensor, Operator};

pub fn gather(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let (x, indices) = (call.input(0)?, call.input(1)?);
    let axis = axis_in(if call.inputs().len() > 2 { call.int(2)? } else { 0 }, x.rank())?;
    if call.attr().int("batch_dims").unwrap_or(0) != 0 {
        return gather_batched(ctx, call, axis);
    }
    let mut dims = x.dims();
    dims.splice(axis..=axis, indices.dims());
    let picked = ctx.plain(indices)?;
    let picked = ctx.cast(&picked, ElementType::Int)?;
    // With one index axis in place of the old one the order is kept.
    let (wire, stored, order) = match indices.rank() {
        0 => (x.wire.clone(), x.order.stored(axis), x.order.without(&[axis])),
        1 => (x.wire.clone(), x.order.stored(axis), x.order.clone()),
        _ => (ctx.plain(x)?, axis, Order::plain(dims.len())),
    };
    let operator = Operator::new("Gather").int("axis", stored as i64);
    Ok(vec![ctx.emit(call, operator, &[&wire, &picked], x.kind(), &dims, order)?])
}

/// Gathers one list of indices per element of the first axis, as `GatherND` with batches.
fn gather_batched(ctx: &mut Lowering, call: &Call, axis: usize) -> Result<Vec<Value>> {
    let (x, indices) = (call.input(0)?, call.input(1)?);
    let batch = call.attr().int("batch_dims").unwrap_or(0);
    if batch != axis as i64 || indices.rank() < axis {
        return Err(Error::unsupported(format!(
            "gathering with {batch} batch dimensions on axis {axis} is not supported"
        )));
    }
    let data = ctx.plain(x)?;
    let picked = ctx.plain(indices)?;
    let last = GraphTensor::ints([indices.rank() as i64]);
    let tuple = [indices.dims(), vec![Some(1)]].concat();
    let picked =
        ctx.graph.add(call.name(), Operator::new("Unsqueeze"), &[&picked, &last], ElementType::Int, tuple)?;
    let dims = [indices.dims(), x.dims()[axis + 1..].to_vec()].concat();
    let operator = Operator::new("GatherND").int("batch_dims", batch);
    Ok(vec![ctx.emit_plain(call, operator, &[&data, &picked], x.kind(), &dims)?])
}

pub fn gather_nd(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let (x, indices) = (call.input(0)?, call.input(1)?);
    let mut dims: Vec<Dim> = indices.dims();
    let depth = dims.pop().flatten().filter(|&depth| depth <= x.rank());
    let depth =
        depth.ok_or_else(|| Error::unsupported("gathering by tuples of open length is not supported"))?;
    dims.extend_from_slice(&x.dims()[depth..]);
    let data = ctx.plain(x)?;
    let picked = ctx.plain(indices)?;
    Ok(vec![ctx.emit_plain(call, Operator::new("GatherND"), &[&data, &picked], x.kind(), &dims)?])
}

pub fn scatter_nd(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let (indices, updates, shape) = (call.input(0)?, call.input(1)?, call.input(2)?);
    let zero = match updates.kind() {
        ElementType::Float => GraphTensor::scalar(0.0),
        _ => GraphTensor::constant(Array::int(0)),
    };
    let zeros = fill_shape(ctx, call, &zero, shape)?;
    let (indices, updates) = (ctx.plain(indices)?, ctx.plain(updates)?);
    let inputs = [&zeros.wire, &indices, &updates];
    Ok(vec![ctx.emit_plain(call, Operator::new("ScatterND"), &inputs, zeros.kind(), &zeros.dims())?])
}

/// Converts `SparseToDense`. Inputs: `indices`, `output_shape`, `values`, `default_value`. Supported where there is nothing to scatter.
pub fn sparse_to_dense(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let (indices, shape, values) = (call.input(0)?, call.input(1)?, call.input(2)?);
    let default = &call.input(3)?.wire;
    let filled = fill_shape(ctx, call, default, shape)?;
    if indices.wire.element_count() == Some(0) {
        return Ok(vec![filled]);
    }
    if indices.rank() != 2 || values.rank() != 1 {
        return Err(Error::unsupported("a sparse tensor with a single index or value is not supported"));
    }
    let inputs = [&filled.wire, &indices.wire, &values.wire];
    Ok(vec![ctx.emit_plain(call, Operator::new("ScatterND"), &inputs, filled.kind(), &filled.dims())?])
}
