//! Maximum and average pooling.

use burn::backend::ir::{ModuleOperationIr, TensorIr};
use opendr_engine::Result;
use opendr_onnx::Operator;

use super::convolution::{ints, pads};
use super::lowering::Lowering;

pub(super) fn lower(graph: &mut Lowering<'_>, operation: &ModuleOperationIr) -> Result<bool> {
    use ModuleOperationIr as Op;
    macro_rules! maximum {
        ($op:expr, $kernel:expr, $stride:expr, $padding:expr, $dilation:expr) => {{
            let window = Window { kernel: $kernel, stride: $stride, padding: $padding, dilation: $dilation };
            let mut operator = window.operator("MaxPool", $op.ceil_mode, &$op.x, &$op.out);
            // The default is left out.
            if $dilation.iter().any(|&dilation| dilation != 1) {
                operator = operator.ints("dilations", ints($dilation));
            }
            graph.apply(operator, &[&$op.x], &$op.out)?;
        }};
    }
    macro_rules! mean {
        ($op:expr, $kernel:expr, $stride:expr, $padding:expr) => {{
            let window = Window { kernel: $kernel, stride: $stride, padding: $padding, dilation: &[1; 2] };
            // Runtimes disagree on whether a border beyond the padding counts.
            if $op.ceil_mode
                && $op.count_include_pad
                && window.pads(true, &$op.x, &$op.out) != window.pads(false, &$op.x, &$op.out)
            {
                return Ok(false);
            }
            let operator = window.operator("AveragePool", $op.ceil_mode, &$op.x, &$op.out);
            let operator = operator.int("count_include_pad", i64::from($op.count_include_pad));
            graph.apply(operator, &[&$op.x], &$op.out)?;
        }};
    }
    match operation {
        Op::MaxPool1d(op) => maximum!(op, &[op.kernel_size], &[op.stride], &[op.padding], &[op.dilation]),
        Op::MaxPool2d(op) => maximum!(op, &op.kernel_size, &op.stride, &op.padding, &op.dilation),
        // The indices of the maxima are needed only for the backward pass.
        Op::MaxPool1dWithIndices(op) => {
            maximum!(op, &[op.kernel_size], &[op.stride], &[op.padding], &[op.dilation])
        }
        Op::MaxPool2dWithIndices(op) => maximum!(op, &op.kernel_size, &op.stride, &op.padding, &op.dilation),
        Op::AvgPool1d(op) => mean!(op, &[op.kernel_size], &[op.stride], &[op.padding]),
        Op::AvgPool2d(op) => mean!(op, &op.kernel_size, &op.stride, &op.padding),
        _ => return Ok(false),
    }
    Ok(true)
}

struct Window<'a> {
    kernel: &'a [usize],
    stride: &'a [usize],
    padding: &'a [usize],
    dilation: &'a [usize],
}

impl Window<'_> {
    fn operator(&self, name: &'static str, ceil: bool, x: &TensorIr, out: &TensorIr) -> Operator {
        Operator::new(name)
            .ints("kernel_shape", ints(self.kernel))
            .ints("strides", ints(self.stride))
            .ints("pads", pads(&self.pads(ceil, x, out)))
    }

    /// Returns the padding before and after each axis; the extra output of `ceil` becomes padding after, on which all runtimes
    /// agree.
    fn pads(&self, ceil: bool, x: &TensorIr, out: &TensorIr) -> Vec<(usize, usize)> {
        let axis = |axis: usize| {
            let (kernel, stride, before) = (self.kernel[axis], self.stride[axis], self.padding[axis]);
            if !ceil {
                return (before, before);
            }
            let (size, count) = (x.shape[axis + 2], out.shape[axis + 2]);
            let reach = count.saturating_sub(1) * stride + (kernel - 1) * self.dilation[axis] + 1;
            (before, reach.saturating_sub(size + before))
        };
        (0..self.kernel.len()).map(axis).collect()
    }
}
