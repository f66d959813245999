//! Comparisons and logic.

use burn::backend::ir::{
    BaseOperationIr, BinaryOpIr, BoolOperationIr, NumericOperationIr, ScalarOpIr, TensorIr,
};
use opendr_engine::Result;
use opendr_onnx::{ElementType, GraphTensor, Operator};

use super::lowering::{Lowering, scalar};
use super::rearrangement::cast;

pub(super) fn lower(graph: &mut Lowering<'_>, operation: &BaseOperationIr) -> Result<bool> {
    use BaseOperationIr as Op;
    match operation {
        Op::Equal(op) => tensors(graph, "Equal", op)?,
        Op::EqualElem(op) => with_scalar(graph, "Equal", op)?,
        Op::NotEqual(op) => {
            let (x, y) = (graph.wire(&op.lhs)?, graph.wire(&op.rhs)?);
            unequal(graph, &x, &y, &op.out)?;
        }
        Op::NotEqualElem(op) => {
            let (x, y) = (graph.wire(&op.lhs)?, scalar(op.rhs, op.lhs.dtype)?);
            unequal(graph, &x, &y, &op.out)?;
        }
        _ => return Ok(false),
    }
    Ok(true)
}

pub(super) fn lower_numeric(graph: &mut Lowering<'_>, operation: &NumericOperationIr) -> Result<bool> {
    use NumericOperationIr as Op;
    match operation {
        Op::Greater(op) => tensors(graph, "Greater", op)?,
        Op::GreaterElem(op) => with_scalar(graph, "Greater", op)?,
        Op::GreaterEqual(op) => tensors(graph, "GreaterOrEqual", op)?,
        Op::GreaterEqualElem(op) => with_scalar(graph, "GreaterOrEqual", op)?,
        Op::Lower(op) => tensors(graph, "Less", op)?,
        Op::LowerElem(op) => with_scalar(graph, "Less", op)?,
        Op::LowerEqual(op) => tensors(graph, "LessOrEqual", op)?,
        Op::LowerEqualElem(op) => with_scalar(graph, "LessOrEqual", op)?,
        _ => return Ok(false),
    }
    Ok(true)
}

pub(super) fn lower_bool(graph: &mut Lowering<'_>, operation: &BoolOperationIr) -> Result<bool> {
    use BoolOperationIr as Op;
    match operation {
        Op::Not(op) => graph.apply(Operator::new("Not"), &[&op.input], &op.out)?,
        Op::And(op) => tensors(graph, "And", op)?,
        Op::Or(op) => tensors(graph, "Or", op)?,
        Op::Xor(op) => tensors(graph, "Xor", op)?,
        Op::IntoFloat(op) | Op::IntoInt(op) => cast(graph, &op.input, &op.out)?,
    }
    Ok(true)
}

fn tensors(graph: &mut Lowering<'_>, name: &'static str, op: &BinaryOpIr) -> Result<()> {
    graph.apply(Operator::new(name), &[&op.lhs, &op.rhs], &op.out)
}

fn with_scalar(graph: &mut Lowering<'_>, name: &'static str, op: &ScalarOpIr) -> Result<()> {
    let (x, value) = (graph.wire(&op.lhs)?, scalar(op.rhs, op.lhs.dtype)?);
    graph.write(Operator::new(name), &[&x, &value], &op.out)
}

fn unequal(graph: &mut Lowering<'_>, x: &GraphTensor, y: &GraphTensor, out: &TensorIr) -> Result<()> {
    let dims = graph.dims(out);
    let equal = graph.step(Operator::new("Equal"), &[x, y], ElementType::Bool, dims)?;
    graph.write(Operator::new("Not"), &[&equal], out)
}
