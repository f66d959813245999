//! Activations.

use std::f32::consts::FRAC_1_SQRT_2;

use burn::backend::ir::{ActivationOperationIr, DimOpIr, TensorIr};
use opendr_engine::Result;
use opendr_onnx::{GraphTensor, Operator};

use super::lowering::Lowering;

pub(super) fn lower(graph: &mut Lowering<'_>, operation: &ActivationOperationIr) -> Result<bool> {
    use ActivationOperationIr as Op;
    match operation {
        Op::Relu(op) => graph.apply(Operator::new("Relu"), &[&op.input], &op.out)?,
        Op::Sigmoid(op) => graph.apply(Operator::new("Sigmoid"), &[&op.input], &op.out)?,
        Op::PRelu(op) => graph.apply(Operator::new("PRelu"), &[&op.lhs, &op.rhs], &op.out)?,
        Op::LeakyRelu(op) => {
            let slope = op.rhs.elem();
            graph.apply(Operator::new("LeakyRelu").float("alpha", slope), &[&op.lhs], &op.out)?;
        }
        Op::HardSigmoid(op) => {
            let operator =
                Operator::new("HardSigmoid").float("alpha", op.alpha.elem()).float("beta", op.beta.elem());
            graph.apply(operator, &[&op.tensor], &op.out)?;
        }
        Op::Gelu(op) => gelu(graph, &op.input, &op.out)?,
        Op::LogSigmoid(op) => {
            // log σ(x) = -softplus(-x)
            let x = graph.wire(&op.input)?;
            let negated = graph.step_like(Operator::new("Neg"), &[&x], &x)?;
            let softplus = graph.step_like(Operator::new("Softplus"), &[&negated], &x)?;
            graph.write(Operator::new("Neg"), &[&softplus], &op.out)?;
        }
        Op::Softmax(op) => along(graph, "Softmax", op)?,
        Op::LogSoftmax(op) => along(graph, "LogSoftmax", op)?,
        Op::Softmin(op) => {
            let x = graph.wire(&op.input)?;
            let negated = graph.step_like(Operator::new("Neg"), &[&x], &x)?;
            graph.write(Operator::new("Softmax").int("axis", op.axis as i64), &[&negated], &op.out)?;
        }
        _ => return Ok(false),
    }
    Ok(true)
}

fn along(graph: &mut Lowering<'_>, name: &'static str, op: &DimOpIr) -> Result<()> {
    graph.apply(Operator::new(name).int("axis", op.axis as i64), &[&op.input], &op.out)
}

/// Exact GELU, `x / 2 * (1 + erf(x / √2))`; ONNX has an operator for it only from opset 20 on.
fn gelu(graph: &mut Lowering<'_>, input: &TensorIr, out: &TensorIr) -> Result<()> {
    let x = graph.wire(input)?;
    let scaled = graph.step_like(Operator::new("Mul"), &[&x, &GraphTensor::scalar(FRAC_1_SQRT_2)], &x)?;
    let erf = graph.step_like(Operator::new("Erf"), &[&scaled], &x)?;
    let shifted = graph.step_like(Operator::new("Add"), &[&erf, &GraphTensor::scalar(1.0)], &x)?;
    let product = graph.step_like(Operator::new("Mul"), &[&x, &shifted], &x)?;
    graph.write(Operator::new("Mul"), &[&product, &GraphTensor::scalar(0.5)], out)
}
