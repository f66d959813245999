//! Mapping of layers to ONNX operators.

use opendr_engine::{Error, Result};
use opendr_onnx::{Dim, GraphTensor, Operator};

use super::activation::activation;
use super::param::Layer;
use super::product::{batch_norm, convolution, inner_product, parametric, pooling};
use super::shape::{concat, flat, permute, reshape};
use super::trace::Trace;

/// Unary operators, by ncnn's operation type.
const UNARY: [&str; 17] = [
    "Abs",
    "Neg",
    "Floor",
    "Ceil",
    "",
    "Sqrt",
    "",
    "Exp",
    "Log",
    "Sin",
    "Cos",
    "Tan",
    "Asin",
    "Acos",
    "Atan",
    "Reciprocal",
    "Tanh",
];
/// Binary operators, by ncnn's operation type; from [`TURNED`] on the operands are swapped.
const BINARY: [&str; 9] = ["Add", "Sub", "Mul", "Div", "Max", "Min", "Pow", "Sub", "Div"];
const TURNED: i64 = 7;

/// Converts a layer and returns its output. All layers have one output except `Split`, whose outputs are identical.
///
/// # Errors
/// `Unsupported` for an unknown layer, `Format` for invalid parameters and inputs.
pub fn output(trace: &mut Trace<'_>, layer: &Layer<'_>) -> Result<GraphTensor> {
    let parameters = &layer.parameters;
    match layer.kind {
        "Convolution" | "ConvolutionDepthWise" => convolution(trace, layer),
        "InnerProduct" => inner_product(trace, layer),
        "BatchNorm" => batch_norm(trace, layer),
        "PReLU" => parametric(trace, layer),
        "Pooling" => pooling(trace, layer),
        "Reshape" => reshape(trace, layer),
        "Permute" => permute(trace, layer),
        "Concat" => concat(trace, layer),
        "BinaryOp" => binary(trace, layer),
        "Gemm" => product(trace, layer),
        "Split" | "Dropout" | "Noop" => trace.input(layer, 0),
        "Flatten" => {
            let input = trace.input(layer, 0)?;
            flat(trace, layer, &input)
        }
        "UnaryOp" => {
            let number = parameters.int(0, 0)?;
            let input = trace.input(layer, 0)?;
            match usize::try_from(number).ok().and_then(|number| UNARY.get(number).copied()) {
                Some("") if number == 4 => trace.same(layer, Operator::new("Mul"), &[&input, &input]),
                Some("") => {
                    let root = trace.same(layer, Operator::new("Sqrt"), &[&input])?;
                    trace.same(layer, Operator::new("Reciprocal"), &[&root])
                }
                Some(name) => trace.same(layer, Operator::new(name), &[&input]),
                None => Err(Error::unsupported(format!("unsupported unary operator {number}"))),
            }
        }
        "Sigmoid" | "TanH" | "HardSigmoid" | "HardSwish" | "Swish" | "Clip" | "ReLU" => {
            let input = trace.input(layer, 0)?;
            let (first, second) = match layer.kind {
                "HardSigmoid" | "HardSwish" => (parameters.float(0, 0.2)?, parameters.float(1, 0.5)?),
                "Clip" => (parameters.float(0, f32::MIN)?, parameters.float(1, f32::MAX)?),
                _ => (parameters.float(0, 0.0)?, 0.0),
            };
            activation(trace, layer, layer.kind, [first, second], &input)
        }
        "Softmax" => {
            let input = trace.input(layer, 0)?;
            let axes = input.rank() as i64 - 1;
            let axis = parameters.int(0, 0)?;
            match (-axes..axes).contains(&axis) {
                true => {
                    let axis = if axis < 0 { axis + axes } else { axis } + 1;
                    trace.same(layer, Operator::new("Softmax").int("axis", axis), &[&input])
                }
                false => Err(Error::format(format!("axis {axis} is out of range for {axes} axes"))),
            }
        }
        _ => Err(Error::unsupported("this layer type is not supported")),
    }
}

/// Converts `BinaryOp`: two tensors, of which one may have a value per channel, or a tensor and a number.
fn binary(trace: &mut Trace<'_>, layer: &Layer<'_>) -> Result<GraphTensor> {
    let parameters = &layer.parameters;
    let number = parameters.int(0, 0)?;
    let name = usize::try_from(number).ok().and_then(|number| BINARY.get(number).copied());
    let name = name.ok_or_else(|| Error::unsupported(format!("unsupported binary operator {number}")))?;
    let mut first = trace.input(layer, 0)?;
    let mut second = match parameters.int(1, 0)? {
        0 => trace.input(layer, 1)?,
        _ => GraphTensor::scalar(parameters.float(2, 0.0)?),
    };
    let is_scalar = second.rank() == 0;
    if !is_scalar && first.rank() != second.rank() {
        let (high, low) =
            if first.rank() > second.rank() { (&first, &mut second) } else { (&second, &mut first) };
        // A vector has one value per channel.
        let (2, rank) = (low.rank(), high.rank()) else {
            return Err(Error::unsupported("two tensors with incompatible numbers of axes"));
        };
        let sides = vec![Some(1); rank - 2];
        let dims = [low.dims().to_vec(), sides].concat();
        let axes = GraphTensor::ints(2..rank as i64);
        *low = trace.add(layer, Operator::new("Unsqueeze"), &[&*low, &axes], dims)?;
    }
    let dims = if is_scalar { first.dims().to_vec() } else { broadcast(first.dims(), second.dims())? };
    let inputs = if number >= TURNED { [&second, &first] } else { [&first, &second] };
    trace.add(layer, Operator::new(name), &inputs, dims)
}

/// Returns the broadcast dimensions of two tensors of equal rank.
fn broadcast(a: &[Dim], b: &[Dim]) -> Result<Vec<Dim>> {
    let side = |(a, b): (&Dim, &Dim)| match (*a, *b) {
        (Some(1), other) | (other, Some(1)) => Ok(other),
        (Some(a), Some(b)) if a != b => Err(Error::format(format!("the sizes {a} and {b} do not match"))),
        (a, b) => Ok(a.or(b)),
    };
    a.iter().zip(b).map(side).collect()
}

/// Converts a `Gemm` of two matrices.
fn product(trace: &mut Trace<'_>, layer: &Layer<'_>) -> Result<GraphTensor> {
    let (a, b) = (trace.input(layer, 0)?, trace.input(layer, 1)?);
    let parameters = &layer.parameters;
    let plain = parameters.float(0, 1.0)? == 1.0 && layer.inputs.len() == 2;
    let changed = (2..=14).any(|key| parameters.int(key, 0).is_ok_and(|value| value != 0));
    if !plain || changed || a.rank() != 3 || b.rank() != 3 {
        return Err(Error::unsupported("only products of two matrices are supported"));
    }
    if let (Some(columns), Some(rows)) = (a.dims()[2], b.dims()[1])
        && columns != rows
    {
        return Err(Error::format(format!(
            "a matrix of {columns} columns cannot be multiplied by one of {rows} rows"
        )));
    }
    let dims = vec![Some(1), a.dims()[1], b.dims()[2]];
    trace.add(layer, Operator::new("MatMul"), &[&a, &b], dims)
}
