//! Tensors filled with one value.

use burn::backend::ir::{BaseOperationIr, NumericOperationIr, ScalarIr, TensorIr};
use opendr_engine::Result;
use opendr_onnx::{GraphTensor, Operator};

use super::lowering::{Lowering, scalar};

pub(super) fn lower(graph: &mut Lowering<'_>, operation: &BaseOperationIr) -> Result<bool> {
    match operation {
        BaseOperationIr::Zeros(op) => fill(graph, ScalarIr::Int(0), &op.out)?,
        BaseOperationIr::Ones(op) => fill(graph, ScalarIr::Int(1), &op.out)?,
        _ => return Ok(false),
    }
    Ok(true)
}

pub(super) fn lower_numeric(graph: &mut Lowering<'_>, operation: &NumericOperationIr) -> Result<bool> {
    match operation {
        NumericOperationIr::Full(op) => fill(graph, op.value, &op.out)?,
        _ => return Ok(false),
    }
    Ok(true)
}

fn fill(graph: &mut Lowering<'_>, value: ScalarIr, out: &TensorIr) -> Result<()> {
    let value = scalar(value, out.dtype)?;
    let sizes = graph.sizes(out);
    let shape: GraphTensor = graph.shape(&sizes)?;
    graph.write(Operator::new("Expand"), &[&value, &shape], out)
}
