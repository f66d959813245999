//! Operators with weights, whose order in TensorFlow Lite differs from TensorFlow's.

use opendr_engine::{Error, Result};

use super::model::Node;
use super::options::Options;
use super::step::{Step, list, missing};
use super::trace::Trace;
use super::window::{Fields, four, padding, window};
use crate::tensorflow::{Attribute, Attributes, Order, Value};

/// Order of filters in ONNX, in TensorFlow's axes: output channels, input channels, height, width.
const FILTER: [usize; 4] = [3, 2, 0, 1];

/// Returns the weights of a node: input 1, of which TensorFlow's axis `i` is axis `axes[i]`.
fn weight(trace: &mut Trace, node: &Node, axes: &[usize], stored: &Order) -> Result<Value> {
    let tensor = node.inputs.get(1).copied().flatten().ok_or_else(|| missing(node, 1))?;
    trace.weight(tensor, axes, stored)
}

/// Adds the parameter for a bias as the third input.
fn with_bias(attr: Attributes, bias: &Option<Value>) -> Attributes {
    let fused = bias.iter().map(|_| "BiasAdd".to_owned()).collect();
    attr.with("fused_ops", Attribute::Texts(fused))
}

/// Converts a convolution; a depthwise one becomes a convolution of as many groups, as its filter has one input
/// channel.
pub fn convolution<'a, 'f>(
    trace: &mut Trace<'_, 'a, 'f>,
    node: &Node<'a, 'f>,
    depthwise: bool,
) -> Result<Step> {
    let (axes, activation) = if depthwise { ([1, 2, 0, 3], 4) } else { ([1, 2, 3, 0], 3) };
    let options = Options::of(node);
    let filter = weight(trace, node, &axes, &Order::new(FILTER.to_vec()))?;
    let bias = trace.optional(node, 2)?;
    let attr = window(&options, &Fields { dilation: Some(activation + 1), kernel: None })?;
    let attr = with_bias(attr, &bias);
    let inputs = [trace.input(node, 0)?, filter].into_iter().chain(bias).collect();
    Ok(Step { op: "Conv2D", attr, inputs, activation: options.activation(activation)? })
}

/// Converts `TRANSPOSE_CONV`: the output's shape, the filter, the image, optionally a bias.
pub fn transposed<'a, 'f>(trace: &mut Trace<'_, 'a, 'f>, node: &Node<'a, 'f>) -> Result<Step> {
    let options = Options::of(node);
    let filter = weight(trace, node, &[1, 2, 0, 3], &Order::new(FILTER.to_vec()))?;
    let attr = window(&options, &Fields { dilation: None, kernel: None })?;
    let inputs = vec![trace.input(node, 0)?, filter, trace.input(node, 2)?];
    let bias = trace.optional(node, 3)?;
    transposed_and_biased(trace, attr, inputs, bias, options.activation(3)?)
}

fn transposed_and_biased(
    trace: &mut Trace,
    attr: Attributes,
    inputs: Vec<Value>,
    bias: Option<Value>,
    activation: Option<&'static str>,
) -> Result<Step> {
    let op = "Conv2DBackpropInput";
    let Some(bias) = bias else { return Ok(Step { op, attr, inputs, activation }) };
    let mut inputs = trace.call("transposed", op, &attr, inputs)?;
    inputs.push(bias);
    Ok(Step { op: "BiasAdd", attr: Attributes::default(), inputs, activation })
}

/// Converts MediaPipe's custom transposed convolution: image, filter, bias. Its parameters are three integers:
/// padding (1 for `SAME`, 2 for `VALID`), horizontal and vertical stride.
pub fn custom_transposed<'a, 'f>(trace: &mut Trace<'_, 'a, 'f>, node: &Node<'a, 'f>) -> Result<Step> {
    let words: Vec<i32> =
        node.custom_options.as_chunks().0.iter().map(|&word| i32::from_le_bytes(word)).collect();
    let [same_or_valid, stride_width, stride_height, ..] = words[..] else {
        return Err(Error::format(format!(
            "the custom parameters have {} bytes instead of 12",
            node.custom_options.len()
        )));
    };
    let image = trace.input(node, 0)?;
    let filter = weight(trace, node, &[1, 2, 0, 3], &Order::new(FILTER.to_vec()))?;
    let [Some(height), Some(width), Some(filters), _] = filter.dims()[..] else {
        return Err(Error::unsupported("a filter of open size is not supported"));
    };
    let number = u8::try_from(same_or_valid.saturating_sub(1)).unwrap_or(u8::MAX);
    let grown = |dim: Option<usize>, stride: i32, kernel: usize| {
        let stride = usize::try_from(stride).ok().filter(|stride| (1..=1 << 16).contains(stride))?;
        let dim = dim.filter(|dim| (1..=1 << 24).contains(dim))?;
        let size = if number == 0 { dim * stride } else { (dim - 1) * stride + kernel };
        i64::try_from(size).ok()
    };
    let dims = image.dims();
    let size = match dims[..] {
        [_, rows, columns, _] => grown(rows, stride_height, height).zip(grown(columns, stride_width, width)),
        _ => None,
    };
    let (rows, columns) = size.ok_or_else(|| {
        Error::unsupported(format!("a transposed convolution of an image {dims:?} is not supported"))
    })?;
    let attr = Attributes::default()
        .with("padding", padding(number)?)
        .with("strides", four(stride_height, stride_width))
        .with("dilations", four(1, 1));
    let shape = list([1, rows, columns, filters as i64]);
    let bias = trace.optional(node, 2)?;
    transposed_and_biased(trace, attr, vec![shape, filter, image], bias, None)
}

/// Converts a matrix product with the rows of `x`, for any number of leading axes.
pub fn fully_connected<'a, 'f>(trace: &mut Trace<'_, 'a, 'f>, node: &Node<'a, 'f>) -> Result<Step> {
    let options = Options::of(node);
    if options.byte(1)? != 0 {
        return Err(Error::unsupported("shuffled weights are not supported"));
    }
    let activation = options.activation(0)?;
    let x = trace.input(node, 0)?;
    let weight = weight(trace, node, &[1, 0], &Order::plain(2))?;
    let bias = trace.optional(node, 2)?;
    let (columns, filters) = match weight.dims()[..] {
        [Some(columns), Some(filters)] => (columns as i64, filters as i64),
        _ => return Err(Error::unsupported("weights of open size are not supported")),
    };
    let outer = x.dims();
    let rows = match x.rank() {
        2 => vec![x],
        _ => trace.call("rows", "Reshape", &Attributes::default(), vec![x, list([-1, columns])])?,
    };
    let attr = with_bias(Attributes::default(), &bias);
    let inputs: Vec<Value> = rows.into_iter().chain([weight]).chain(bias).collect();
    if options.byte(2)? == 0 || outer.len() == 2 {
        return Ok(Step { op: "_FusedMatMul", attr, inputs, activation });
    }
    let mut product = trace.call("product", "_FusedMatMul", &attr, inputs)?;
    let kept = outer.len().saturating_sub(1);
    let dims = outer[..kept].iter().map(|dim| dim.map_or(-1, |dim| dim as i64)).chain([filters]);
    product.push(list(dims));
    Ok(Step { op: "Reshape", attr: Attributes::default(), inputs: product, activation })
}
