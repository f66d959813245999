//! Scaled dot-product attention.

use burn::backend::ir::{AttentionOpIr, ModuleOperationIr};
use opendr_engine::{Error, Result};
use opendr_onnx::{Data, ElementType, GraphTensor, Operator};

use super::lowering::{Lowering, array};

/// Writes `softmax(q kᵀ · scale) v` with Burn's options for the scores: a soft cap, masks, a bias.
pub(super) fn lower(graph: &mut Lowering<'_>, operation: &ModuleOperationIr) -> Result<bool> {
    let ModuleOperationIr::Attention(op) = operation else { return Ok(false) };
    let weights = scores(graph, op)?;
    let weights = graph.step_like(Operator::new("Softmax").int("axis", -1), &[&weights], &weights)?;
    let value = graph.wire(&op.value)?;
    graph.write(Operator::new("MatMul"), &[&weights, &value], &op.out)?;
    Ok(true)
}

fn scores(graph: &mut Lowering<'_>, op: &AttentionOpIr) -> Result<GraphTensor> {
    let (query, key) = (graph.wire(&op.query)?, graph.wire(&op.key)?);
    let [batch, heads, steps, _] = query.dims() else { return Err(rank()) };
    let [_, _, others, depth] = key.dims() else { return Err(rank()) };
    let dims = vec![*batch, *heads, *steps, *others];
    let (steps, others) = (*steps, *others);
    let scale = match (op.options.scale, depth) {
        (Some(scale), _) => scale.elem(),
        (None, Some(depth)) => 1.0 / (*depth as f32).sqrt(),
        (None, None) => {
            return Err(Error::unsupported("attention over an open number of features is not supported"));
        }
    };
    let mut transposed = key.dims().to_vec();
    transposed.swap(2, 3);
    let key = graph.step(
        Operator::new("Transpose").ints("perm", [0, 1, 3, 2]),
        &[&key],
        ElementType::Float,
        transposed,
    )?;
    let product = graph.step(Operator::new("MatMul"), &[&query, &key], ElementType::Float, dims)?;
    let mut scores =
        graph.step_like(Operator::new("Mul"), &[&product, &GraphTensor::scalar(scale)], &product)?;
    if let Some(cap) = op.options.softcap {
        let cap = GraphTensor::scalar(cap.elem());
        scores = graph.step_like(Operator::new("Div"), &[&scores, &cap], &product)?;
        scores = graph.step_like(Operator::new("Tanh"), &[&scores], &product)?;
        scores = graph.step_like(Operator::new("Mul"), &[&scores, &cap], &product)?;
    }
    let mask = op.mask.as_ref().map(|mask| graph.wire(mask)).transpose()?;
    let causal = if op.options.is_causal { Some(future(steps, others)?) } else { None };
    // A finite value, so that a fully masked row is not NaN.
    let lowest = GraphTensor::scalar(f32::MIN);
    for mask in mask.iter().chain(&causal) {
        scores = graph.step_like(Operator::new("Where"), &[mask, &lowest, &scores], &product)?;
    }
    if let Some(bias) = &op.attn_bias {
        let bias = graph.wire(bias)?;
        scores = graph.step_like(Operator::new("Add"), &[&scores, &bias], &product)?;
    }
    Ok(scores)
}

fn rank() -> Error {
    Error::internal("attention needs tensors of four axes")
}

/// Returns the mask of causal attention: which of `others` come after each of `steps`.
fn future(steps: Option<usize>, others: Option<usize>) -> Result<GraphTensor> {
    let (Some(steps), Some(others)) = (steps, others) else {
        return Err(Error::unsupported("causal attention over an open number of steps is not supported"));
    };
    let after = (0..steps).flat_map(|step| (0..others).map(move |other| other > step)).collect();
    Ok(GraphTensor::constant(array(vec![1, 1, steps, others], Data::Bool(after))?))
}
