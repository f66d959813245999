//! Convolutions and transposed convolutions of one to three axes.

use burn::backend::ir::{ModuleOperationIr, TensorIr};
use opendr_engine::Result;
use opendr_onnx::{GraphTensor, Operator};

use super::lowering::Lowering;

pub(super) fn lower(graph: &mut Lowering<'_>, operation: &ModuleOperationIr) -> Result<bool> {
    use ModuleOperationIr as Op;
    macro_rules! convolution {
        ($op:expr, $pads:expr) => {{
            let operator = Operator::new("Conv")
                .ints("kernel_shape", kernel(&$op.weight))
                .ints("strides", ints(&$op.options.stride))
                .ints("pads", $pads)
                .ints("dilations", ints(&$op.options.dilation))
                .int("group", $op.options.groups as i64);
            write(graph, operator, [&$op.x, &$op.weight], $op.bias.as_ref(), &$op.out)?;
        }};
    }
    macro_rules! transposed {
        ($op:expr) => {{
            let operator = Operator::new("ConvTranspose")
                .ints("kernel_shape", kernel(&$op.weight))
                .ints("strides", ints(&$op.options.stride))
                .ints("pads", twice(&$op.options.padding))
                .ints("output_padding", ints(&$op.options.padding_out))
                .ints("dilations", ints(&$op.options.dilation))
                .int("group", $op.options.groups as i64);
            write(graph, operator, [&$op.x, &$op.weight], $op.bias.as_ref(), &$op.out)?;
        }};
    }
    match operation {
        Op::Conv1d(op) => convolution!(op, pads(&op.options.padding)),
        Op::Conv2d(op) => convolution!(op, pads(&op.options.padding)),
        Op::Conv3d(op) => convolution!(op, twice(&op.options.padding)),
        Op::ConvTranspose1d(op) => transposed!(op),
        Op::ConvTranspose2d(op) => transposed!(op),
        Op::ConvTranspose3d(op) => transposed!(op),
        _ => return Ok(false),
    }
    Ok(true)
}

fn write(
    graph: &mut Lowering<'_>,
    operator: Operator,
    [x, weight]: [&TensorIr; 2],
    bias: Option<&TensorIr>,
    out: &TensorIr,
) -> Result<()> {
    let (x, weight) = (graph.wire(x)?, graph.wire(weight)?);
    let bias = bias.map(|bias| graph.wire(bias)).transpose()?;
    let inputs: Vec<&GraphTensor> = [&x, &weight].into_iter().chain(&bias).collect();
    graph.write(operator, &inputs, out)
}

fn kernel(weight: &TensorIr) -> Vec<i64> {
    weight.shape.iter().skip(2).map(|&dim| dim as i64).collect()
}

pub(super) fn ints(values: &[usize]) -> Vec<i64> {
    values.iter().map(|&value| value as i64).collect()
}

/// ONNX's order: padding before each axis, then padding after each axis.
pub(super) fn pads(padding: &[(usize, usize)]) -> Vec<i64> {
    padding.iter().map(|pad| pad.0 as i64).chain(padding.iter().map(|pad| pad.1 as i64)).collect()
}

fn twice(padding: &[usize]) -> Vec<i64> {
    [ints(padding), ints(padding)].concat()
}
