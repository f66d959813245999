//! Activations, as layers and fused into layers with weights.

use opendr_engine::{Error, Result};
use opendr_onnx::{GraphTensor, Operator};

use super::param::Layer;
use super::trace::Trace;

/// Applies the fused activation of a layer with weights: parameters 9 and 10.
pub fn activated(trace: &mut Trace<'_>, layer: &Layer<'_>, wire: GraphTensor) -> Result<GraphTensor> {
    let values = layer.parameters.list(10);
    let value = |at: usize| {
        values
            .get(at)
            .copied()
            .ok_or_else(|| Error::format(format!("the activation has {} parameters", values.len())))
    };
    let (kind, values) = match layer.parameters.int(9, 0)? {
        0 => return Ok(wire),
        1 => ("ReLU", [0.0, 0.0]),
        2 => ("ReLU", [value(0)?, 0.0]),
        3 => ("Clip", [value(0)?, value(1)?]),
        4 => ("Sigmoid", [0.0, 0.0]),
        6 => ("HardSwish", [value(0)?, value(1)?]),
        other => return Err(Error::unsupported(format!("unsupported activation {other}"))),
    };
    activation(trace, layer, kind, values, &wire)
}

/// Applies an activation by its layer type, with up to two parameters.
pub fn activation(
    trace: &mut Trace<'_>,
    layer: &Layer<'_>,
    kind: &str,
    [first, second]: [f32; 2],
    input: &GraphTensor,
) -> Result<GraphTensor> {
    let hard = || Operator::new("HardSigmoid").float("alpha", first).float("beta", second);
    match kind {
        "ReLU" if first == 0.0 => trace.same(layer, Operator::new("Relu"), &[input]),
        "ReLU" => trace.same(layer, Operator::new("LeakyRelu").float("alpha", first), &[input]),
        "Clip" => {
            let (low, high) = (GraphTensor::scalar(first), GraphTensor::scalar(second));
            trace.same(layer, Operator::new("Clip"), &[input, &low, &high])
        }
        "Sigmoid" => trace.same(layer, Operator::new("Sigmoid"), &[input]),
        "TanH" => trace.same(layer, Operator::new("Tanh"), &[input]),
        "HardSigmoid" => trace.same(layer, hard(), &[input]),
        "HardSwish" => {
            let gate = trace.same(layer, hard(), &[input])?;
            trace.same(layer, Operator::new("Mul"), &[input, &gate])
        }
        "Swish" => {
            let gate = trace.same(layer, Operator::new("Sigmoid"), &[input])?;
            trace.same(layer, Operator::new("Mul"), &[input, &gate])
        }
        other => Err(Error::internal(format!("activation {other}"))),
    }
}
