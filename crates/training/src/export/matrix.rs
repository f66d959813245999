//! Matrix products.

use burn::backend::ir::{FloatOperationIr, ModuleOperationIr};
use opendr_engine::Result;
use opendr_onnx::{ElementType, Operator};

use super::lowering::Lowering;

pub(super) fn lower(graph: &mut Lowering<'_>, operation: &FloatOperationIr) -> Result<bool> {
    match operation {
        FloatOperationIr::Matmul(op) => graph.apply(Operator::new("MatMul"), &[&op.lhs, &op.rhs], &op.out)?,
        _ => return Ok(false),
    }
    Ok(true)
}

/// Writes `x W + b`, with `W` of shape `[in, out]`.
pub(super) fn lower_module(graph: &mut Lowering<'_>, operation: &ModuleOperationIr) -> Result<bool> {
    let ModuleOperationIr::Linear(op) = operation else { return Ok(false) };
    let Some(bias) = &op.bias else {
        graph.apply(Operator::new("MatMul"), &[&op.x, &op.weight], &op.out)?;
        return Ok(true);
    };
    let (x, weight, bias) = (graph.wire(&op.x)?, graph.wire(&op.weight)?, graph.wire(bias)?);
    let dims = graph.dims(&op.out);
    let product = graph.step(Operator::new("MatMul"), &[&x, &weight], ElementType::Float, dims)?;
    graph.write(Operator::new("Add"), &[&product, &bias], &op.out)?;
    Ok(true)
}
