//! Arithmetic, powers, clamping and padding.

use burn::backend::ir::{BinaryOpIr, NumericOperationIr, PadModeIr, PadOpIr, ScalarOpIr, TensorIr};
use opendr_engine::Result;
use opendr_onnx::{ElementType, GraphTensor, Operator};

use super::lowering::{Lowering, kind_from_dtype, scalar};

pub(super) fn lower(graph: &mut Lowering<'_>, operation: &NumericOperationIr) -> Result<bool> {
    use NumericOperationIr as Op;
    match operation {
        Op::Add(op) => binary(graph, "Add", op)?,
        Op::Sub(op) => binary(graph, "Sub", op)?,
        Op::Mul(op) => binary(graph, "Mul", op)?,
        Op::Div(op) => binary(graph, "Div", op)?,
        Op::Powi(op) => binary(graph, "Pow", op)?,
        Op::AddScalar(op) => with_scalar(graph, "Add", op)?,
        Op::SubScalar(op) => with_scalar(graph, "Sub", op)?,
        Op::MulScalar(op) => with_scalar(graph, "Mul", op)?,
        Op::DivScalar(op) => with_scalar(graph, "Div", op)?,
        Op::PowiScalar(op) => power(graph, op)?,
        Op::Rem(op) => {
            let (x, y) = (graph.wire(&op.lhs)?, graph.wire(&op.rhs)?);
            remainder(graph, &x, &y, &op.out)?;
        }
        Op::RemScalar(op) => {
            let (x, y) = (graph.wire(&op.lhs)?, scalar(op.rhs, op.lhs.dtype)?);
            remainder(graph, &x, &y, &op.out)?;
        }
        Op::Abs(op) => graph.apply(Operator::new("Abs"), &[&op.input], &op.out)?,
        Op::Neg(op) => graph.apply(Operator::new("Neg"), &[&op.input], &op.out)?,
        Op::Sign(op) => graph.apply(Operator::new("Sign"), &[&op.input], &op.out)?,
        Op::Clamp(op) => {
            let (low, high) = (scalar(op.min, op.tensor.dtype)?, scalar(op.max, op.tensor.dtype)?);
            let x = graph.wire(&op.tensor)?;
            graph.write(Operator::new("Clip"), &[&x, &low, &high], &op.out)?;
        }
        Op::ClampMin(op) => with_scalar(graph, "Max", op)?,
        Op::ClampMax(op) => with_scalar(graph, "Min", op)?,
        Op::Pad(op) => pad(graph, op)?,
        _ => return Ok(false),
    }
    Ok(true)
}

fn binary(graph: &mut Lowering<'_>, name: &'static str, op: &BinaryOpIr) -> Result<()> {
    graph.apply(Operator::new(name), &[&op.lhs, &op.rhs], &op.out)
}

fn with_scalar(graph: &mut Lowering<'_>, name: &'static str, op: &ScalarOpIr) -> Result<()> {
    let (x, value) = (graph.wire(&op.lhs)?, scalar(op.rhs, op.lhs.dtype)?);
    graph.write(Operator::new(name), &[&x, &value], &op.out)
}

/// Writes a power; squares are products, which are faster and also correct for negative bases.
pub(super) fn power(graph: &mut Lowering<'_>, op: &ScalarOpIr) -> Result<()> {
    if op.rhs.elem::<f64>() == 2.0 {
        return graph.apply(Operator::new("Mul"), &[&op.lhs, &op.lhs], &op.out);
    }
    with_scalar(graph, "Pow", op)
}

/// Burn's remainder has the sign of the divisor: ONNX's `Mod` for integers, `x - y * floor(x / y)` for floats.
fn remainder(graph: &mut Lowering<'_>, x: &GraphTensor, y: &GraphTensor, out: &TensorIr) -> Result<()> {
    if kind_from_dtype(out.dtype)? == ElementType::Int {
        return graph.write(Operator::new("Mod"), &[x, y], out);
    }
    let dims = graph.dims(out);
    let quotient = graph.step(Operator::new("Div"), &[x, y], ElementType::Float, dims)?;
    let whole = graph.step_like(Operator::new("Floor"), &[&quotient], &quotient)?;
    let taken = graph.step_like(Operator::new("Mul"), &[&whole, y], &quotient)?;
    graph.write(Operator::new("Sub"), &[x, &taken], out)
}

fn pad(graph: &mut Lowering<'_>, op: &PadOpIr) -> Result<()> {
    let missing = op.input.shape.num_dims().saturating_sub(op.padding.len());
    let pads = || std::iter::repeat_n(&(0, 0), missing).chain(&op.padding);
    let pads = GraphTensor::ints(pads().map(|pad| pad.0 as i64).chain(pads().map(|pad| pad.1 as i64)));
    let x = graph.wire(&op.input)?;
    match op.mode {
        PadModeIr::Constant(value) => {
            let value = scalar(value, op.input.dtype)?;
            graph.write(Operator::new("Pad").text("mode", "constant"), &[&x, &pads, &value], &op.out)
        }
        PadModeIr::Reflect => {
            graph.write(Operator::new("Pad").text("mode", "reflect"), &[&x, &pads], &op.out)
        }
        PadModeIr::Edge => graph.write(Operator::new("Pad").text("mode", "edge"), &[&x, &pads], &op.out),
    }
}
