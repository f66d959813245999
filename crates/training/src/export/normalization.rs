//! Batch and layer normalisation.

use burn::backend::ir::ModuleOperationIr;
use opendr_engine::Result;
use opendr_onnx::{GraphTensor, Operator};

use super::lowering::Lowering;

pub(super) fn lower(graph: &mut Lowering<'_>, operation: &ModuleOperationIr) -> Result<bool> {
    match operation {
        ModuleOperationIr::BatchNorm(op) => {
            let operator = Operator::new("BatchNormalization").float("epsilon", op.epsilon.elem());
            graph.apply(operator, &[&op.x, &op.gamma, &op.beta, &op.mean, &op.variance], &op.out)?;
        }
        ModuleOperationIr::LayerNorm(op) => {
            let operator =
                Operator::new("LayerNormalization").int("axis", -1).float("epsilon", op.epsilon.elem());
            let (x, gamma) = (graph.wire(&op.input)?, graph.wire(&op.gamma)?);
            let beta = op.beta.as_ref().map(|beta| graph.wire(beta)).transpose()?;
            let inputs: Vec<&GraphTensor> = [&x, &gamma].into_iter().chain(&beta).collect();
            graph.write(operator, &inputs, &op.out)?;
        }
        _ => return Ok(false),
    }
    Ok(true)
}
