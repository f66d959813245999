//! Reshaping, squeezing, expansion and transposition.

use opendr_engine::{Error, Result};

use crate::tensorflow::call::{Call, axis_in};
use crate::tensorflow::lowering::Lowering;
use crate::tensorflow::value::Value;
use opendr_onnx::{Dim, ElementType, GraphTensor, Operator};

pub fn reshape(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let shape = call.input(1)?;
    let Some(wanted) = shape.array() else { return reshape_to_computed(ctx, call, x, shape) };
    let wanted = wanted.as_ints().ok_or_else(|| Error::format("the shape must be integers"))?;
    let dims = resolved(wanted, x)?;
    let target = |dims: &[Dim]| GraphTensor::ints(dims.iter().map(|dim| dim.map_or(-1, |dim| dim as i64)));
    let known: Option<Vec<usize>> = dims.iter().copied().collect();
    if let (Some(from), Some(to)) = (x.known_dims(), known)
        && let Some(order) = x.order.reshaped(&from, &to)
    {
        let shape = target(&order.stored_dims(&dims));
        return Ok(vec![ctx.emit(call, operator(&dims), &[&x.wire, &shape], x.kind(), &dims, order)?]);
    }
    let plain = ctx.plain(x)?;
    let value = ctx.emit_plain(call, operator(&dims), &[&plain, &target(&dims)], x.kind(), &dims)?;
    if !x.order.is_plain() {
        ctx.note_flattened(&value.wire, x);
    }
    Ok(vec![value])
}

/// In TensorFlow a zero means no elements, in ONNX by default "as in the input".
fn operator(dims: &[Dim]) -> Operator {
    let operator = Operator::new("Reshape");
    if dims.contains(&Some(0)) { operator.int("allowzero", 1) } else { operator }
}

/// Returns the shape with -1 replaced where the number of elements is known; `None` is known at run time only.
fn resolved(wanted: &[i64], x: &Value) -> Result<Vec<Dim>> {
    let nonsense = || Error::format(format!("cannot reshape {:?} to {wanted:?}", x.dims()));
    let mut dims = Vec::with_capacity(wanted.len());
    let mut product = 1usize;
    for &dim in wanted {
        dims.push(match dim {
            -1 => None,
            dim => Some(usize::try_from(dim).map_err(|_| nonsense())?),
        });
        product = product.checked_mul(dims.last().copied().flatten().unwrap_or(1)).ok_or_else(nonsense)?;
    }
    let open = dims.iter().filter(|dim| dim.is_none()).count();
    match (x.wire.element_count(), open) {
        (_, 2..) => return Err(nonsense()),
        (Some(count), 0) if count != product => return Err(nonsense()),
        (Some(count), 1) if product > 0 && count % product == 0 => {
            dims.iter_mut().filter(|dim| dim.is_none()).for_each(|dim| *dim = Some(count / product));
        }
        (Some(_), 1) => return Err(nonsense()),
        _ => {}
    }
    Ok(dims)
}

/// Writes a reshape to a shape that the model computes.
fn reshape_to_computed(ctx: &mut Lowering, call: &Call, x: &Value, shape: &Value) -> Result<Vec<Value>> {
    let elements = match (shape.wire.elements(), shape.dims().as_slice()) {
        (Some(elements), _) => elements,
        (None, [Some(rank @ 0..=8)]) => vec![None; *rank],
        (None, dims) => {
            return Err(Error::unsupported(format!(
                "a reshape to a shape of shape {dims:?} is not supported"
            )));
        }
    };
    let dims: Vec<Dim> = elements.iter().map(|dim| dim.and_then(|dim| usize::try_from(dim).ok())).collect();
    let plain = ctx.plain(x)?;
    Ok(vec![ctx.emit_plain(call, Operator::new("Reshape"), &[&plain, &shape.wire], x.kind(), &dims)?])
}

pub fn squeeze(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let listed = ["squeeze_dims", "axis"].map(|key| call.attr().ints(key)).concat();
    let axes: Vec<usize> = match listed.is_empty() {
        true => (0..x.rank()).filter(|&axis| x.dims()[axis] == Some(1)).collect(),
        false => listed.iter().map(|&axis| axis_in(axis, x.rank())).collect::<Result<_>>()?,
    };
    Ok(vec![squeezed(ctx, call, x, &axes)?])
}

/// Removes TensorFlow's axes `axes`, which have size one.
pub fn squeezed(ctx: &mut Lowering, call: &Call, x: &Value, axes: &[usize]) -> Result<Value> {
    if axes.is_empty() {
        return Ok(x.clone());
    }
    let dims = x.dims();
    if let Some(axis) = axes.iter().find(|&&axis| dims[axis].is_some_and(|dim| dim != 1)) {
        return Err(Error::format(format!("axis {axis} of {dims:?} cannot be squeezed")));
    }
    let mut stored: Vec<i64> = axes.iter().map(|&axis| x.order.stored(axis) as i64).collect();
    stored.sort_unstable();
    stored.dedup();
    let kept: Vec<Dim> = (0..x.rank()).filter(|axis| !axes.contains(axis)).map(|axis| dims[axis]).collect();
    let inputs = [&x.wire, &GraphTensor::ints(stored)];
    ctx.emit(call, Operator::new("Squeeze"), &inputs, x.kind(), &kept, x.order.without(axes))
}

pub fn expand_dims(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let axis = axis_in(call.int(1)?, x.rank() + 1)?;
    Ok(vec![expanded(ctx, call, x, axis)?])
}

/// Inserts an axis of size one.
pub fn expanded(ctx: &mut Lowering, call: &Call, x: &Value, axis: usize) -> Result<Value> {
    let (order, position) = x.order.with(axis);
    let mut dims = x.dims();
    dims.insert(axis, Some(1));
    let inputs = [&x.wire, &GraphTensor::ints([position as i64])];
    ctx.emit(call, Operator::new("Unsqueeze"), &inputs, x.kind(), &dims, order)
}

/// Renames the axes; only constants are transposed, because they are always stored in TensorFlow's order.
pub fn transpose(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let perm: Vec<usize> =
        call.ints(1)?.iter().map(|&axis| axis_in(axis, x.rank())).collect::<Result<_>>()?;
    let mut sorted = perm.clone();
    sorted.sort_unstable();
    if !sorted.iter().copied().eq(0..x.rank()) {
        return Err(Error::format(format!(
            "the permutation {perm:?} does not match a tensor of rank {}",
            x.rank()
        )));
    }
    let value = Value::new(x.wire.clone(), x.order.transposed(&perm));
    match x.array() {
        Some(_) => Ok(vec![Value::plain(ctx.plain(&value)?)]),
        None => Ok(vec![value]),
    }
}

/// Returns integers of any shape as a list, for operators that need a list where TensorFlow has a scalar.
pub fn as_list(ctx: &mut Lowering, wire: &GraphTensor) -> Result<GraphTensor> {
    let dims = vec![wire.element_count()];
    ctx.graph.add(
        &wire.hint(),
        Operator::new("Reshape"),
        &[wire, &GraphTensor::ints([-1])],
        ElementType::Int,
        dims,
    )
}
