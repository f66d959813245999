//! Shapes as values, and tensors created from shapes.

use opendr_engine::{Error, Result};

use crate::tensorflow::call::Call;
use crate::tensorflow::lowering::Lowering;
use crate::tensorflow::value::Value;
use opendr_onnx::{Array, Data, Dim, ElementType, GraphTensor, Operator};

/// Returns TensorFlow's dimensions as integers; known ones stay known in later arithmetic.
pub fn shape(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let rank = [Some(x.rank())];
    let stored = ctx.emit_plain(call, Operator::new("Shape"), &[&x.wire], ElementType::Int, &rank)?;
    if x.order.is_plain() {
        return Ok(vec![stored]);
    }
    let positions = GraphTensor::ints((0..x.rank()).map(|axis| x.order.stored(axis) as i64));
    let gather = Operator::new("Gather").int("axis", 0);
    Ok(vec![ctx.emit_plain(call, gather, &[&stored.wire, &positions], ElementType::Int, &rank)?])
}

pub fn size(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    Ok(vec![ctx.emit_plain(call, Operator::new("Size"), &[&x.wire], ElementType::Int, &[])?])
}

pub fn rank(_: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    Ok(vec![Value::plain(GraphTensor::constant(Array::int(call.input(0)?.rank() as i64)))])
}

pub fn fill(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let value = call.input(1)?;
    Ok(vec![fill_shape(ctx, call, &value.wire, call.input(0)?)?])
}

/// Returns a scalar repeated over a shape.
pub fn fill_shape(ctx: &mut Lowering, call: &Call, scalar: &GraphTensor, shape: &Value) -> Result<Value> {
    let dims = shape_dims(shape)?;
    ctx.emit_plain(call, Operator::new("Expand"), &[scalar, &shape.wire], scalar.kind(), &dims)
}

/// Returns the dimensions of a tensor of the shape in `shape`.
fn shape_dims(shape: &Value) -> Result<Vec<Dim>> {
    match (shape.wire.elements(), shape.dims().as_slice()) {
        (Some(elements), _) => {
            Ok(elements.iter().map(|dim| dim.and_then(|dim| usize::try_from(dim).ok())).collect())
        }
        (None, [Some(rank @ 0..=8)]) => Ok(vec![None; *rank]),
        (None, dims) => Err(Error::unsupported(format!("a shape of shape {dims:?} is not supported"))),
    }
}

pub fn range(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let float = call.inputs().iter().any(|input| input.kind() == ElementType::Float);
    let kind = if float { ElementType::Float } else { ElementType::Int };
    let mut limits = Vec::with_capacity(3);
    for index in 0..3 {
        limits.push(ctx.cast(&call.input(index)?.wire, kind)?);
    }
    let inputs: Vec<&GraphTensor> = limits.iter().collect();
    let value = ctx.emit_plain(call, Operator::new("Range"), &inputs, kind, &[None])?;
    // If it was evaluated, the length is known.
    Ok(vec![Value::plain(value.wire)])
}

/// Returns zeros or ones in the shape of another tensor.
pub fn filled_like(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let value = i64::from(call.op() == "OnesLike");
    let scalar = match x.kind() {
        ElementType::Float => Array::scalar(value as f32),
        ElementType::Int => Array::int(value),
        ElementType::Bool => {
            Array::new(Vec::new(), Data::Bool(vec![value == 1])).unwrap_or_else(|| Array::int(value))
        }
    };
    let shape = shape(ctx, call)?.remove(0);
    Ok(vec![fill_shape(ctx, call, &GraphTensor::constant(scalar), &shape)?])
}

pub fn broadcast_to(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let (x, shape) = (call.input(0)?, call.input(1)?);
    let mut dims = shape_dims(shape)?;
    let missing = dims
        .len()
        .checked_sub(x.rank())
        .ok_or_else(|| Error::format("a tensor cannot be broadcast to a lower rank"))?;
    for (own, dim) in dims[missing..].iter_mut().zip(x.dims()) {
        *own = own.or(dim.filter(|&dim| dim != 1));
    }
    let plain = ctx.plain(x)?;
    Ok(vec![ctx.emit_plain(call, Operator::new("Expand"), &[&plain, &shape.wire], x.kind(), &dims)?])
}
