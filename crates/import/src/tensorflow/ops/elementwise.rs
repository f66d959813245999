//! Element-wise operators with NumPy's broadcasting.

use opendr_engine::{Error, Result};

use crate::tensorflow::call::Call;
use crate::tensorflow::layout::Order;
use crate::tensorflow::lowering::Lowering;
use crate::tensorflow::value::Value;
use opendr_onnx::{Dim, ElementType, GraphTensor, Operator};

/// Operands with a common element type and order, ready to broadcast.
struct Aligned {
    wires: Vec<GraphTensor>,
    order: Order,
    /// TensorFlow's dimensions of the result.
    dims: Vec<Dim>,
}

/// Uses the order of the largest operand, so that the fewest elements move.
fn align(ctx: &mut Lowering, values: &[&Value]) -> Result<Aligned> {
    let rank = values.iter().map(|value| value.rank()).max().unwrap_or(0);
    let computed = values.iter().filter(|value| value.rank() == rank && value.array().is_none());
    let largest = computed
        .max_by_key(|value| (value.wire.element_count().unwrap_or(usize::MAX), !value.order.is_plain()));
    let order = largest.map_or_else(|| Order::plain(rank), |value| value.order.clone());
    let float = values.iter().any(|value| value.kind() == ElementType::Float);
    let mut wires = Vec::with_capacity(values.len());
    let mut dims: Vec<Dim> = Vec::new();
    for value in values {
        let wire = match largest {
            Some(_) => ctx.broadcastable(value, &order)?,
            None => ctx.plain(value)?,
        };
        wires.push(if float && value.kind() == ElementType::Int {
            ctx.cast(&wire, ElementType::Float)?
        } else {
            wire
        });
        dims = broadcast(&dims, &value.dims())?;
    }
    Ok(Aligned { wires, order, dims })
}

/// Returns the dimensions after broadcasting; two open dimensions are assumed equal.
fn broadcast(a: &[Dim], b: &[Dim]) -> Result<Vec<Dim>> {
    let rank = a.len().max(b.len());
    let dim = |dims: &[Dim], axis: usize| (axis + dims.len()).checked_sub(rank).map_or(Some(1), |i| dims[i]);
    (0..rank)
        .map(|axis| match (dim(a, axis), dim(b, axis)) {
            (x, y) if x == y => Ok(x),
            (Some(1), y) => Ok(y),
            (x, Some(1)) => Ok(x),
            (None, y) => Ok(y),
            (x, None) => Ok(x),
            (Some(x), Some(y)) => {
                Err(Error::format(format!("operands of {x} and {y} elements cannot be broadcast")))
            }
        })
        .collect()
}

/// Applies a binary ONNX operator to two values.
pub fn apply(ctx: &mut Lowering, call: &Call, name: &'static str, x: &Value, y: &Value) -> Result<Value> {
    let Aligned { wires, order, dims } = align(ctx, &[x, y])?;
    let comparison =
        matches!(name, "Equal" | "Less" | "LessOrEqual" | "Greater" | "GreaterOrEqual" | "And" | "Or");
    let kind = if comparison { ElementType::Bool } else { wires[0].kind() };
    ctx.emit(call, Operator::new(name), &[&wires[0], &wires[1]], kind, &dims, order)
}

/// Applies a unary ONNX operator, keeping the order.
pub fn apply_unary(ctx: &mut Lowering, call: &Call, operator: Operator, x: &Value) -> Result<Value> {
    ctx.emit(call, operator, &[&x.wire], x.kind(), &x.dims(), x.order.clone())
}

pub fn binary(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let name = match call.op() {
        "Add" | "AddV2" => "Add",
        "Sub" => "Sub",
        "Mul" => "Mul",
        "RealDiv" | "Div" => "Div",
        "Pow" => "Pow",
        "Maximum" => "Max",
        "Minimum" => "Min",
        "Less" => "Less",
        "LessEqual" => "LessOrEqual",
        "Greater" => "Greater",
        "GreaterEqual" => "GreaterOrEqual",
        "LogicalAnd" => "And",
        "LogicalOr" => "Or",
        _ => "Equal",
    };
    Ok(vec![apply(ctx, call, name, call.input(0)?, call.input(1)?)?])
}

pub fn not_equal(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let equal = apply(ctx, call, "Equal", call.input(0)?, call.input(1)?)?;
    Ok(vec![apply_unary(ctx, call, Operator::new("Not"), &equal)?])
}

/// Divides and rounds towards minus infinity; ONNX's integer division rounds towards zero.
pub fn floor_div(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let (x, y) = (call.input(0)?, call.input(1)?);
    if x.kind() == ElementType::Float || y.kind() == ElementType::Float {
        let quotient = apply(ctx, call, "Div", x, y)?;
        return Ok(vec![apply_unary(ctx, call, Operator::new("Floor"), &quotient)?]);
    }
    let remainder = apply(ctx, call, "Mod", x, y)?;
    let whole = apply(ctx, call, "Sub", x, &remainder)?;
    Ok(vec![apply(ctx, call, "Div", &whole, y)?])
}

pub fn floor_mod(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let (x, y) = (call.input(0)?, call.input(1)?);
    if x.kind() != ElementType::Float && y.kind() != ElementType::Float {
        return Ok(vec![apply(ctx, call, "Mod", x, y)?]);
    }
    let quotient = apply(ctx, call, "Div", x, y)?;
    let quotient = apply_unary(ctx, call, Operator::new("Floor"), &quotient)?;
    let whole = apply(ctx, call, "Mul", &quotient, y)?;
    Ok(vec![apply(ctx, call, "Sub", x, &whole)?])
}

pub fn squared_difference(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let difference = apply(ctx, call, "Sub", call.input(0)?, call.input(1)?)?;
    Ok(vec![apply(ctx, call, "Mul", &difference, &difference)?])
}

/// Computes the angle of (x, y), which ONNX lacks, from `Atan` and the quadrant.
pub fn atan2(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    use std::f32::consts::{FRAC_PI_2, PI};
    let (y, x) = (call.input(0)?, call.input(1)?);
    let constant = |value: f32| Value::plain(GraphTensor::scalar(value));
    let zero = constant(0.0);
    let quotient = apply(ctx, call, "Div", y, x)?;
    let angle = apply_unary(ctx, call, Operator::new("Atan"), &quotient)?;
    let below = apply(ctx, call, "Less", y, &zero)?;
    let half_turn = choose(ctx, call, &below, &constant(-PI), &constant(PI))?;
    let left = apply(ctx, call, "Add", &angle, &half_turn)?;
    let sign = apply_unary(ctx, call, Operator::new("Sign"), y)?;
    let upright = apply(ctx, call, "Mul", &sign, &constant(FRAC_PI_2))?;
    let is_left = apply(ctx, call, "Less", x, &zero)?;
    let is_right = apply(ctx, call, "Greater", x, &zero)?;
    let beside = choose(ctx, call, &is_left, &left, &upright)?;
    Ok(vec![choose(ctx, call, &is_right, &angle, &beside)?])
}

pub fn add_n(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let mut sum = call.input(0)?.clone();
    for value in call.inputs().iter().skip(1) {
        sum = apply(ctx, call, "Add", &sum, value)?;
    }
    Ok(vec![sum])
}

pub fn bias_add(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    if call.attr().text("data_format") == Some("NCHW") {
        return Err(Error::unsupported("a bias on channels-first data is not supported"));
    }
    Ok(vec![apply(ctx, call, "Add", call.input(0)?, call.input(1)?)?])
}

pub fn unary(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let name = match call.op() {
        "Abs" => "Abs",
        "Neg" => "Neg",
        "Exp" => "Exp",
        "Log" => "Log",
        "Sqrt" => "Sqrt",
        "Sin" => "Sin",
        "Cos" => "Cos",
        "Atan" => "Atan",
        "Floor" => "Floor",
        "Ceil" => "Ceil",
        "Round" => "Round",
        "Erf" => "Erf",
        "Sign" => "Sign",
        "Reciprocal" => "Reciprocal",
        _ => "Not",
    };
    Ok(vec![apply_unary(ctx, call, Operator::new(name), call.input(0)?)?])
}

pub fn square(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    Ok(vec![apply(ctx, call, "Mul", call.input(0)?, call.input(0)?)?])
}

pub fn rsqrt(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let root = apply_unary(ctx, call, Operator::new("Sqrt"), call.input(0)?)?;
    Ok(vec![apply_unary(ctx, call, Operator::new("Reciprocal"), &root)?])
}

pub fn cast(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let x = call.input(0)?;
    let kind = call.attr().kind("DstT");
    let kind = kind.ok_or_else(|| {
        Error::unsupported("a cast to a type other than numbers and booleans is not supported")
    })?;
    Ok(vec![Value::new(ctx.cast(&x.wire, kind)?, x.order.clone())])
}

pub fn clip(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let low = apply(ctx, call, "Max", call.input(0)?, call.input(1)?)?;
    Ok(vec![apply(ctx, call, "Min", &low, call.input(2)?)?])
}

/// Selects `condition ? x : y`.
fn choose(ctx: &mut Lowering, call: &Call, condition: &Value, x: &Value, y: &Value) -> Result<Value> {
    let Aligned { wires, order, dims } = align(ctx, &[condition, x, y])?;
    ctx.emit(call, Operator::new("Where"), &[&wires[0], &wires[1], &wires[2]], wires[1].kind(), &dims, order)
}

pub fn select(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let (condition, x, y) = (call.input(0)?, call.input(1)?, call.input(2)?);
    if call.op() == "Select" && condition.rank() == 1 && x.rank() > 1 {
        return Err(Error::unsupported("the selection of whole rows is not supported"));
    }
    Ok(vec![choose(ctx, call, condition, x, y)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn open_dimensions_broadcast() {
        let broadcast = |a: &[Dim], b: &[Dim]| broadcast(a, b).ok();
        assert_eq!(broadcast(&[None, Some(3)], &[Some(3)]), Some(vec![None, Some(3)]));
        assert_eq!(broadcast(&[Some(1)], &[None]), Some(vec![None]));
        assert_eq!(broadcast(&[None], &[Some(4)]), Some(vec![Some(4)]));
        assert_eq!(broadcast(&[Some(2)], &[Some(3)]), None);
    }
}
