//! Mapping of TensorFlow Lite's operators to TensorFlow's.

use opendr_engine::{Error, Result};
use opendr_onnx::{Array, GraphTensor};

use super::model::Node;
use super::names::{name, same};
use super::options::Options;
use super::product::{convolution, custom_transposed, fully_connected, transposed};
use super::step::{Step, list};
use super::trace::Trace;
use super::window::{Fields, window};
use crate::tensorflow::{Attribute, Attributes, Value};

fn integer(value: i64) -> Value {
    Value::plain(GraphTensor::constant(Array::int(value)))
}

/// Returns the equivalent of an operator in TensorFlow.
///
/// # Errors
/// `Unsupported` for an unknown operator, `Format` for invalid parameters and inputs.
pub fn step<'a, 'f>(trace: &mut Trace<'_, 'a, 'f>, node: &Node<'a, 'f>) -> Result<Step> {
    if node.custom == "Convolution2DTransposeBias" {
        return custom_transposed(trace, node);
    }
    let unknown = || Error::unsupported("this operator is not supported");
    let name = name(node.code).ok_or_else(unknown)?;
    let options = Options::of(node);
    match name {
        "CONV_2D" | "DEPTHWISE_CONV_2D" => return convolution(trace, node, name == "DEPTHWISE_CONV_2D"),
        "TRANSPOSE_CONV" => return transposed(trace, node),
        "FULLY_CONNECTED" => return fully_connected(trace, node),
        "DENSIFY" => {
            return Err(Error::unsupported(
                "sparse weights are not supported; use a model with dense weights",
            ));
        }
        "L2_NORMALIZATION" => return normalised(trace, node),
        _ => {}
    }
    let mut inputs = trace.inputs(node)?;
    let none = Attributes::default();
    let mut activation = None;
    let (op, attr) = match name {
        "ADD" | "SUB" | "MUL" | "DIV" => {
            activation = options.activation(0)?;
            let op = [("ADD", "AddV2"), ("SUB", "Sub"), ("MUL", "Mul"), ("DIV", "RealDiv")];
            (op.iter().find(|(own, _)| *own == name).map_or("", |(_, op)| op), none)
        }
        "AVERAGE_POOL_2D" | "MAX_POOL_2D" => {
            activation = options.activation(5)?;
            let op = if name == "MAX_POOL_2D" { "MaxPool" } else { "AvgPool" };
            (op, window(&options, &Fields { dilation: None, kernel: Some(3) })?)
        }
        "CONCATENATION" => {
            activation = options.activation(1)?;
            inputs.push(integer(options.int(0, 0)?.into()));
            ("ConcatV2", none)
        }
        "DEPTH_TO_SPACE" => ("DepthToSpace", none.with("block_size", options.number(0)?)),
        "DEQUANTIZE" => {
            if let (Some(Some(original)), Some(&copy)) = (node.inputs.first(), node.outputs.first()) {
                trace.note_same(copy, *original);
            }
            ("", none)
        }
        "QUANTIZE" => ("", none),
        "RESHAPE" => {
            if inputs.len() == 1 {
                inputs.push(list(options.ints(0)?));
            }
            ("Reshape", none)
        }
        "RESIZE_BILINEAR" | "RESIZE_NEAREST_NEIGHBOR" => {
            let (op, first) =
                if name == "RESIZE_BILINEAR" { ("ResizeBilinear", 2) } else { ("ResizeNearestNeighbor", 0) };
            let attr = none.with("align_corners", options.flag(first)?);
            (op, attr.with("half_pixel_centers", options.flag(first + 1)?))
        }
        "SOFTMAX" => {
            let beta = options.float(0, 1.0)?;
            if beta != 1.0 {
                let beta = Value::plain(GraphTensor::scalar(beta));
                inputs =
                    trace.call(name, "Mul", &none, inputs.into_iter().take(1).chain([beta]).collect())?;
            }
            ("Softmax", none)
        }
        "GATHER" => {
            inputs.truncate(2);
            inputs.push(integer(options.int(0, 0)?.into()));
            ("GatherV2", none.with("batch_dims", options.number(1)?))
        }
        "MEAN" => ("Mean", none.with("keep_dims", options.flag(0)?)),
        "SUM" => ("Sum", none.with("keep_dims", options.flag(0)?)),
        "REDUCE_PROD" => ("Prod", none.with("keep_dims", options.flag(0)?)),
        "REDUCE_MAX" => ("Max", none.with("keep_dims", options.flag(0)?)),
        "REDUCE_MIN" => ("Min", none.with("keep_dims", options.flag(0)?)),
        "SQUEEZE" => ("Squeeze", none.with("squeeze_dims", Attribute::Ints(options.ints(0)?))),
        "STRIDED_SLICE" if options.byte(5)? != 0 => {
            return Err(Error::unsupported("a slice with ends relative to its starts is not supported"));
        }
        "STRIDED_SLICE" => {
            let masks = ["begin_mask", "end_mask", "ellipsis_mask", "new_axis_mask", "shrink_axis_mask"];
            let masks = masks.iter().enumerate().map(|(i, key)| Ok(((*key).to_owned(), options.number(i)?)));
            ("StridedSlice", masks.collect::<Result<_>>()?)
        }
        "SPLIT" => ("Split", none.with("num_split", options.number(0)?)),
        "CAST" => {
            let output = node.outputs.first().ok_or_else(|| Error::format("it has no output"))?;
            let kind = trace.model().tensors[*output].element.kind()?;
            ("Cast", none.with("DstT", Attribute::Kind(kind)))
        }
        "PACK" => ("Pack", none.with("axis", options.number(1)?)),
        "UNPACK" => ("Unpack", none.with("num", options.number(0)?).with("axis", options.number(1)?)),
        "LEAKY_RELU" => ("LeakyRelu", none.with("alpha", Attribute::Float(options.float(0, 0.0)?))),
        "MIRROR_PAD" => {
            let mode = if options.byte(0)? == 0 { "REFLECT" } else { "SYMMETRIC" };
            ("MirrorPad", none.with("mode", Attribute::Text(mode.to_owned())))
        }
        "BATCH_MATMUL" => {
            ("BatchMatMulV2", none.with("adj_x", options.flag(0)?).with("adj_y", options.flag(1)?))
        }
        _ => (same(node.code).ok_or_else(unknown)?, none),
    };
    Ok(Step { op, attr, inputs, activation })
}

/// Divides every pixel by its L2 norm.
fn normalised<'a, 'f>(trace: &mut Trace<'_, 'a, 'f>, node: &Node<'a, 'f>) -> Result<Step> {
    let x = trace.input(node, 0)?;
    let (none, keep) =
        (Attributes::default(), Attributes::default().with("keep_dims", Attribute::Flag(true)));
    let last =
        x.rank().checked_sub(1).ok_or_else(|| Error::format("L2 normalisation needs at least one axis"))?;
    let name = x.wire.hint();
    let squares = trace.call(&name, "Square", &none, vec![x.clone()])?;
    let sum = [squares, vec![list([last as i64])]].concat();
    let sum = trace.call(&name, "Sum", &keep, sum)?;
    let least = [sum, vec![Value::plain(GraphTensor::scalar(1e-12))]].concat();
    let least = trace.call(&name, "Maximum", &none, least)?;
    let factor = trace.call(&name, "Rsqrt", &none, least)?;
    let activation = Options::of(node).activation(0)?;
    Ok(Step { op: "Mul", attr: none, inputs: [vec![x], factor].concat(), activation })
}
