//! Element-wise functions and conversions.

use burn::backend::ir::{FloatOperationIr, IntOperationIr, TensorIr, UnaryOpIr};
use opendr_engine::Result;
use opendr_onnx::{GraphTensor, Operator};

use super::arithmetic::power;
use super::lowering::Lowering;
use super::rearrangement::cast;

pub(super) fn lower(graph: &mut Lowering<'_>, operation: &FloatOperationIr) -> Result<bool> {
    use FloatOperationIr as Op;
    match operation {
        Op::Exp(op) => unary(graph, "Exp", op)?,
        Op::Log(op) => unary(graph, "Log", op)?,
        Op::Erf(op) => unary(graph, "Erf", op)?,
        Op::Sqrt(op) => unary(graph, "Sqrt", op)?,
        Op::Cos(op) => unary(graph, "Cos", op)?,
        Op::Cosh(op) => unary(graph, "Cosh", op)?,
        Op::Sin(op) => unary(graph, "Sin", op)?,
        Op::Sinh(op) => unary(graph, "Sinh", op)?,
        Op::Tan(op) => unary(graph, "Tan", op)?,
        Op::Tanh(op) => unary(graph, "Tanh", op)?,
        Op::ArcCos(op) => unary(graph, "Acos", op)?,
        Op::ArcCosh(op) => unary(graph, "Acosh", op)?,
        Op::ArcSin(op) => unary(graph, "Asin", op)?,
        Op::ArcSinh(op) => unary(graph, "Asinh", op)?,
        Op::ArcTan(op) => unary(graph, "Atan", op)?,
        Op::ArcTanh(op) => unary(graph, "Atanh", op)?,
        Op::Round(op) => unary(graph, "Round", op)?,
        Op::Floor(op) => unary(graph, "Floor", op)?,
        Op::Ceil(op) => unary(graph, "Ceil", op)?,
        Op::Recip(op) => unary(graph, "Reciprocal", op)?,
        Op::IsNan(op) => unary(graph, "IsNaN", op)?,
        Op::IsInf(op) => unary(graph, "IsInf", op)?,
        Op::Log1p(op) => {
            let x = graph.wire(&op.input)?;
            let shifted = graph.step_like(Operator::new("Add"), &[&x, &GraphTensor::scalar(1.0)], &x)?;
            graph.write(Operator::new("Log"), &[&shifted], &op.out)?;
        }
        Op::Trunc(op) => {
            let x = graph.wire(&op.input)?;
            let magnitude = graph.step_like(Operator::new("Abs"), &[&x], &x)?;
            let whole = graph.step_like(Operator::new("Floor"), &[&magnitude], &x)?;
            let sign = graph.step_like(Operator::new("Sign"), &[&x], &x)?;
            graph.write(Operator::new("Mul"), &[&whole, &sign], &op.out)?;
        }
        Op::Powf(op) => graph.apply(Operator::new("Pow"), &[&op.lhs, &op.rhs], &op.out)?,
        Op::PowfScalar(op) => power(graph, op)?,
        Op::Hypot(op) => hypotenuse(graph, &op.lhs, &op.rhs, &op.out)?,
        Op::IntoInt(op) => cast(graph, &op.input, &op.out)?,
        _ => return Ok(false),
    }
    Ok(true)
}

pub(super) fn lower_int(graph: &mut Lowering<'_>, operation: &IntOperationIr) -> Result<bool> {
    match operation {
        IntOperationIr::IntoFloat(op) => cast(graph, &op.input, &op.out)?,
        IntOperationIr::Matmul(op) => graph.apply(Operator::new("MatMul"), &[&op.lhs, &op.rhs], &op.out)?,
        _ => return Ok(false),
    }
    Ok(true)
}

fn unary(graph: &mut Lowering<'_>, name: &'static str, op: &UnaryOpIr) -> Result<()> {
    graph.apply(Operator::new(name), &[&op.input], &op.out)
}

fn hypotenuse(graph: &mut Lowering<'_>, x: &TensorIr, y: &TensorIr, out: &TensorIr) -> Result<()> {
    let (x, y) = (graph.wire(x)?, graph.wire(y)?);
    let dims = graph.dims(out);
    let first = graph.step_like(Operator::new("Mul"), &[&x, &x], &x)?;
    let second = graph.step_like(Operator::new("Mul"), &[&y, &y], &y)?;
    let sum = graph.step(Operator::new("Add"), &[&first, &second], x.kind(), dims)?;
    graph.write(Operator::new("Sqrt"), &[&sum], out)
}
