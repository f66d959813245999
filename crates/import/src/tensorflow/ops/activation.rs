//! Activation functions, alone or fused into a convolution or matrix product.

use opendr_engine::{Error, Result};

use super::elementwise::{apply, apply_unary};
use crate::tensorflow::call::Call;
use crate::tensorflow::lowering::Lowering;
use crate::tensorflow::value::Value;
use opendr_onnx::{ElementType, GraphTensor, Operator};

pub fn activation(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let alpha = call.attr().float("alpha").unwrap_or(0.2);
    Ok(vec![activate(ctx, call, call.op(), call.input(0)?, call.inputs().get(1), alpha)?])
}

/// Applies TensorFlow's activation `name`; `slope` is the input of `Prelu`, `alpha` the parameter of `LeakyRelu`.
fn activate(
    ctx: &mut Lowering,
    call: &Call,
    name: &str,
    x: &Value,
    slope: Option<&Value>,
    alpha: f32,
) -> Result<Value> {
    let operator = match name {
        "Relu" => Operator::new("Relu"),
        "Elu" => Operator::new("Elu").float("alpha", 1.0),
        "Selu" => Operator::new("Selu"),
        "Sigmoid" => Operator::new("Sigmoid"),
        "Tanh" => Operator::new("Tanh"),
        "Softplus" => Operator::new("Softplus"),
        "LeakyRelu" => Operator::new("LeakyRelu").float("alpha", alpha),
        "HardSwish" => Operator::new("HardSwish"),
        "Relu6" | "ReluN1To1" | "Relu0To1" => {
            let (low, high) = clipped_to(name);
            let (low, high) = (GraphTensor::scalar(low), GraphTensor::scalar(high));
            let clip = Operator::new("Clip");
            return ctx.emit(
                call,
                clip,
                &[&x.wire, &low, &high],
                ElementType::Float,
                &x.dims(),
                x.order.clone(),
            );
        }
        "Softmax" | "LogSoftmax" => {
            let last =
                x.rank().checked_sub(1).ok_or_else(|| Error::format("softmax needs at least one axis"))?;
            let axis = x.order.stored(last) as i64;
            let name = if name == "Softmax" { "Softmax" } else { "LogSoftmax" };
            Operator::new(name).int("axis", axis)
        }
        "Prelu" => {
            let slope = slope.ok_or_else(|| Error::format("Prelu has no slope"))?;
            let slope = ctx.broadcastable(slope, &x.order)?;
            let prelu = Operator::new("PRelu");
            return ctx.emit(call, prelu, &[&x.wire, &slope], ElementType::Float, &x.dims(), x.order.clone());
        }
        other => return Err(Error::unsupported(format!("unsupported fused operator {other:?}"))),
    };
    apply_unary(ctx, call, operator, x)
}

/// Returns the limits of a clipping activation.
fn clipped_to(name: &str) -> (f32, f32) {
    match name {
        "ReluN1To1" => (-1.0, 1.0),
        "Relu0To1" => (0.0, 1.0),
        _ => (0.0, 6.0),
    }
}

/// Operations fused after a product.
pub struct Epilogue {
    /// Bias added per output channel.
    pub bias: Option<Value>,
    activation: Option<(String, Option<Value>)>,
}

impl Epilogue {
    /// Reads `fused_ops` and the inputs after the first two.
    ///
    /// # Errors
    /// `Format` when an input is missing, `Unsupported` for operators in another order.
    pub fn of(call: &Call) -> Result<Self> {
        let mut epilogue = Self { bias: None, activation: None };
        let mut inputs = call.inputs().iter().skip(2);
        for name in call.attr().texts("fused_ops") {
            let missing = || Error::format(format!("the fused operator {name:?} has no input"));
            if name == "BiasAdd" && epilogue.bias.is_none() && epilogue.activation.is_none() {
                epilogue.bias = Some(inputs.next().ok_or_else(missing)?.clone());
            } else if epilogue.activation.is_none() && name != "BiasAdd" {
                let slope =
                    if name == "Prelu" { Some(inputs.next().ok_or_else(missing)?.clone()) } else { None };
                epilogue.activation = Some((name.clone(), slope));
            } else {
                return Err(Error::unsupported(format!(
                    "unsupported order of fused operators: {name:?} follows another"
                )));
            }
        }
        Ok(epilogue)
    }

    /// Adds the bias, for an operator without a bias input.
    ///
    /// # Errors
    /// Those of the addition.
    pub fn add_bias(&self, ctx: &mut Lowering, call: &Call, x: Value) -> Result<Value> {
        match &self.bias {
            Some(bias) => apply(ctx, call, "Add", &x, bias),
            None => Ok(x),
        }
    }

    /// Applies the activation, if there is one.
    ///
    /// # Errors
    /// `Unsupported` for an unknown activation.
    pub fn activate(&self, ctx: &mut Lowering, call: &Call, x: Value) -> Result<Value> {
        let Some((name, slope)) = &self.activation else { return Ok(x) };
        let alpha = call.attr().float("leakyrelu_alpha").unwrap_or(0.2);
        activate(ctx, call, name, &x, slope.as_ref(), alpha)
    }
}
