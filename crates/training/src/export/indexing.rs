//! Gather, scatter and masks.

use burn::backend::ir::{BaseOperationIr, ModuleOperationIr};
use burn::backend::tensor::IndexingUpdateOp;
use opendr_engine::Result;
use opendr_onnx::Operator;

use super::lowering::{Lowering, scalar};

pub(super) fn lower(graph: &mut Lowering<'_>, operation: &BaseOperationIr) -> Result<bool> {
    use BaseOperationIr as Op;
    match operation {
        Op::Select(op) => {
            graph.apply(
                Operator::new("Gather").int("axis", op.dim as i64),
                &[&op.tensor, &op.indices],
                &op.out,
            )?;
        }
        Op::Gather(op) => {
            let operator = Operator::new("GatherElements").int("axis", op.dim as i64);
            graph.apply(operator, &[&op.tensor, &op.indices], &op.out)?;
        }
        Op::GatherNd(op) => graph.apply(Operator::new("GatherND"), &[&op.data, &op.indices], &op.out)?,
        Op::Scatter(op) => {
            let operator = Operator::new("ScatterElements").int("axis", op.dim as i64);
            let operator = operator.text("reduction", reduction(&op.update));
            graph.apply(operator, &[&op.tensor, &op.indices, &op.value], &op.out)?;
        }
        Op::ScatterNd(op) => {
            let operator = Operator::new("ScatterND").text("reduction", reduction(&op.reduction));
            graph.apply(operator, &[&op.data, &op.indices, &op.values], &op.out)?;
        }
        Op::MaskWhere(op) => {
            graph.apply(Operator::new("Where"), &[&op.mask, &op.value, &op.tensor], &op.out)?
        }
        Op::MaskFill(op) => {
            let (mask, x) = (graph.wire(&op.mask)?, graph.wire(&op.tensor)?);
            let value = scalar(op.value, op.tensor.dtype)?;
            graph.write(Operator::new("Where"), &[&mask, &value, &x], &op.out)?;
        }
        _ => return Ok(false),
    }
    Ok(true)
}

pub(super) fn lower_module(graph: &mut Lowering<'_>, operation: &ModuleOperationIr) -> Result<bool> {
    match operation {
        ModuleOperationIr::Embedding(op) => {
            graph.apply(Operator::new("Gather").int("axis", 0), &[&op.weights, &op.indices], &op.out)?;
        }
        _ => return Ok(false),
    }
    Ok(true)
}

fn reduction(update: &IndexingUpdateOp) -> &'static str {
    match update {
        IndexingUpdateOp::Assign => "none",
        IndexingUpdateOp::Add => "add",
        IndexingUpdateOp::Mul => "mul",
        // Beyond opset 17; ONNX Runtime's error names the attribute.
        IndexingUpdateOp::Min => "min",
        IndexingUpdateOp::Max => "max",
    }
}
