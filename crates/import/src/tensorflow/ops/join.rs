//! Concatenation, stacking and tiling.

use opendr_engine::{Error, Result};

use super::reshape::expanded;
use crate::tensorflow::call::{Call, axis_in};
use crate::tensorflow::layout::Order;
use crate::tensorflow::lowering::Lowering;
use crate::tensorflow::value::Value;
use opendr_onnx::{Dim, ElementType, GraphTensor, Operator};

pub fn concat(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let last = call.inputs().len().checked_sub(1).ok_or_else(|| Error::format("it has no inputs"))?;
    let parts = &call.inputs()[..last];
    let rank = parts.first().ok_or_else(|| Error::format("it has no tensors to concatenate"))?.rank();
    let axis = axis_in(call.int(last)?, rank)?;
    Ok(vec![joined(ctx, call, parts, axis)?])
}

pub fn pack(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let rank = call.input(0)?.rank();
    let axis = axis_in(call.attr().int("axis").unwrap_or(0), rank + 1)?;
    let parts: Vec<Value> = call
        .inputs()
        .iter()
        .map(|part| expanded(ctx, call, part, axis.min(part.rank())))
        .collect::<Result<_>>()?;
    Ok(vec![joined(ctx, call, &parts, axis)?])
}

/// Concatenates along TensorFlow's axis `axis`, in the order of the largest part.
fn joined(ctx: &mut Lowering, call: &Call, parts: &[Value], axis: usize) -> Result<Value> {
    let first = parts.first().ok_or_else(|| Error::format("it has no tensors to concatenate"))?;
    let mut dims = first.dims();
    let mut total: Dim = Some(0);
    for part in parts {
        if part.rank() != dims.len() {
            return Err(Error::format(format!(
                "tensors of ranks {} and {} cannot be concatenated",
                dims.len(),
                part.rank()
            )));
        }
        total = total.zip(part.dims()[axis]).and_then(|(total, dim)| total.checked_add(dim));
        for (own, other) in dims.iter_mut().zip(part.dims()) {
            *own = own.or(other);
        }
    }
    dims[axis] = total;
    let computed = parts.iter().filter(|part| part.array().is_none());
    let largest = computed.max_by_key(|part| part.wire.element_count().unwrap_or(usize::MAX));
    let order = largest.map_or_else(|| Order::plain(dims.len()), |part| part.order.clone());
    let kind = if parts.iter().any(|part| part.kind() == ElementType::Float) {
        ElementType::Float
    } else {
        first.kind()
    };
    let mut wires = Vec::with_capacity(parts.len());
    for part in parts.iter().filter(|part| parts.len() == 1 || part.dims()[axis] != Some(0)) {
        let wire = ctx.ordered(part, &order)?;
        wires.push(ctx.cast(&wire, kind)?);
    }
    if let [single] = wires.as_slice() {
        return Ok(Value::new(single.clone(), order));
    }
    let operator = Operator::new("Concat").int("axis", order.stored(axis) as i64);
    let wires: Vec<&GraphTensor> = wires.iter().collect();
    ctx.emit(call, operator, &wires, kind, &dims, order)
}

pub fn tile(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let (x, repeats) = (call.input(0)?, call.input(1)?);
    let elements = repeats.wire.elements();
    let repeated = |(axis, dim): (usize, Dim)| {
        let repeat = elements.as_ref().and_then(|elements| elements.get(axis).copied().flatten());
        dim?.checked_mul(usize::try_from(repeat?).ok()?)
    };
    let dims: Vec<Dim> = x.dims().into_iter().enumerate().map(repeated).collect();
    let plain = ctx.plain(x)?;
    Ok(vec![ctx.emit_plain(call, Operator::new("Tile"), &[&plain, &repeats.wire], x.kind(), &dims)?])
}
