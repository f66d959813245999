//! Convolutions of images and sequences.

use burn::backend::Flex;
use burn::backend::autodiff::NodeId;
use burn::backend::autodiff::checkpoint::base::Checkpointer;
use burn::backend::autodiff::checkpoint::strategy::NoCheckpointing;
use burn::backend::autodiff::grads::Gradients;
use burn::backend::autodiff::ops::{Backward, Ops, OpsKind};
use burn::nn::conv::{Conv1d, Conv2d};
use burn::nn::{PaddingConfig1d, PaddingConfig2d};
use burn::tensor::Tensor;
use opendr_kernels::{TrainingConvolution, Window, add_column_sums};

use super::{
    Cpu, CpuTrained, Own, Trained, channels_last, compute, from_channels_last, numbers, register, shape,
    tensor,
};

/// Returns the convolution of images `[batch, channels, height, width]`, as [`Conv2d::forward`].
pub fn conv2d(layer: &Conv2d, x: Tensor<4>) -> Tensor<4> {
    let pads = match layer.padding {
        PaddingConfig2d::Valid => Some([0; 4]),
        PaddingConfig2d::Explicit(top, left, bottom, right) => Some([top, left, bottom, right]),
        PaddingConfig2d::Same => None,
    };
    let [_, _, height, width] = x.dims();
    let [_, _, kernel_height, kernel_width] = layer.weight.dims();
    let axes = Axes {
        kernel: [kernel_height, kernel_width],
        strides: layer.stride,
        dilations: layer.dilation,
        input: [height, width],
    };
    let bias = layer.bias.as_ref().map(|bias| bias.val());
    let own =
        pads.and_then(|pads| convolve(&x, &layer.weight.val(), bias, &axes.window(pads)?, layer.groups));
    own.unwrap_or_else(|| layer.forward(x))
}

/// Returns the convolution of sequences `[batch, channels, length]`, as [`Conv1d::forward`].
pub fn conv1d(layer: &Conv1d, x: Tensor<3>) -> Tensor<3> {
    let pads = match layer.padding {
        PaddingConfig1d::Valid => Some([0; 4]),
        PaddingConfig1d::Explicit(left, right) => Some([0, left, 0, right]),
        PaddingConfig1d::Same => None,
    };
    let [_, _, length] = x.dims();
    let [_, _, kernel] = layer.weight.dims();
    let axes = Axes {
        kernel: [1, kernel],
        strides: [1, layer.stride],
        dilations: [1, layer.dilation],
        input: [1, length],
    };
    let bias = layer.bias.as_ref().map(|bias| bias.val());
    let own =
        pads.and_then(|pads| convolve(&x, &layer.weight.val(), bias, &axes.window(pads)?, layer.groups));
    own.unwrap_or_else(|| layer.forward(x))
}

/// A convolution along two axes, of which one is a single pixel in sequences.
struct Axes {
    kernel: [usize; 2],
    strides: [usize; 2],
    dilations: [usize; 2],
    input: [usize; 2],
}

impl Axes {
    /// Returns the geometry with padding above, to the left, below and to the right; `None` where the input is smaller than the kernel.
    fn window(&self, pads: [usize; 4]) -> Option<Window> {
        let &Self { kernel, strides, dilations, input } = self;
        let size = |axis: usize| {
            let span = (kernel[axis] - 1) * dilations[axis] + 1;
            let last = (input[axis] + pads[axis] + pads[axis + 2]).checked_sub(span)?;
            Some(last / strides[axis] + 1)
        };
        let output = [size(0)?, size(1)?];
        Some(Window { kernel, strides, dilations, pads: [pads[0], pads[1]], input, output })
    }
}

/// Returns the convolution of a tensor on the CPU; `None` for others.
fn convolve<const D: usize>(
    x: &Tensor<D>,
    weight: &Tensor<D>,
    bias: Option<Tensor<1>>,
    window: &Window,
    groups: usize,
) -> Option<Tensor<D>> {
    let (shape, outputs) = (x.dims(), weight.dims()[0]);
    let (batch, channels) = (shape[0], shape[1]);
    if weight.dims()[1] * groups != channels {
        return None;
    }
    let sizes = TrainingConvolution { batch, channels, outputs, groups, window: *window };
    let bias = match &bias {
        Some(bias) => Some(Own::of(bias)?),
        None => None,
    };
    Some(match (Own::of(x)?, Own::of(weight)?, bias) {
        (Own::Trained(x), Own::Trained(weight), None) => {
            Tensor::from_primitive::<Trained>(without_bias(x, weight, sizes))
        }
        (Own::Trained(x), Own::Trained(weight), Some(Own::Trained(bias))) => {
            Tensor::from_primitive::<Trained>(with_bias(x, weight, bias, sizes))
        }
        (Own::Plain(x), Own::Plain(weight), None) => {
            Tensor::from_primitive::<Flex>(forward(&sizes, &x, &weight, None))
        }
        (Own::Plain(x), Own::Plain(weight), Some(Own::Plain(bias))) => {
            Tensor::from_primitive::<Flex>(forward(&sizes, &x, &weight, Some(&bias)))
        }
        _ => return None,
    })
}

fn forward(sizes: &TrainingConvolution, x: &Cpu, weight: &Cpu, bias: Option<&Cpu>) -> Cpu {
    let mut of_output = shape(x);
    let spatial = of_output.len() - 2;
    of_output[1] = sizes.outputs;
    of_output[2..].copy_from_slice(&sizes.window.output[2 - spatial..]);
    let (x, weight) = (channels_last(x), weight.to_contiguous());
    let bias = bias.map(Cpu::to_contiguous);
    let y = sizes.forward(compute(), numbers(&x), numbers(&weight), bias.as_ref().map(numbers));
    from_channels_last(y, &of_output)
}

/// Returns the gradients of input and weights that are wanted.
fn gradients(
    sizes: &TrainingConvolution,
    [x, weight]: [&Cpu; 2],
    dy: &Cpu,
    [of_x, of_weight]: [bool; 2],
) -> [Option<Cpu>; 2] {
    let dy = channels_last(dy);
    let dx = of_x.then(|| {
        let dx = sizes.input_gradient(compute(), numbers(&weight.to_contiguous()), numbers(&dy));
        from_channels_last(dx, &shape(x))
    });
    let dw = of_weight.then(|| {
        let mut dw = vec![0.0; sizes.weights_length()];
        sizes.weight_gradient(compute(), numbers(&channels_last(x)), numbers(&dy), &mut dw);
        tensor(dw, shape(weight))
    });
    [dx, dw]
}

type State = (NodeId, NodeId, TrainingConvolution);

#[derive(Debug)]
struct WithoutBias;

impl Backward<Flex, 2> for WithoutBias {
    type State = State;

    fn backward(self, ops: Ops<State, 2>, gradients_of: &mut Gradients, checkpointer: &mut Checkpointer) {
        let dy = gradients_of.consume::<Flex>(&ops.node);
        let (x, weight, sizes) = ops.state;
        let x = checkpointer.retrieve_node_output::<Cpu>(x);
        let weight = checkpointer.retrieve_node_output::<Cpu>(weight);
        let wanted = ops.parents.each_ref().map(Option::is_some);
        let all = gradients(&sizes, [&x, &weight], &dy, wanted);
        register(gradients_of, ops.parents.map(|node| node.map(|node| node.id)), all);
    }
}

fn without_bias(x: CpuTrained, weight: CpuTrained, sizes: TrainingConvolution) -> CpuTrained {
    let y = forward(&sizes, x.primitive(), weight.primitive(), None);
    let prepared =
        WithoutBias.prepare::<NoCheckpointing>([x.node(), weight.node()]).compute_bound().stateful();
    match prepared {
        OpsKind::Tracked(mut prepared) => {
            let state = (prepared.checkpoint(&x), prepared.checkpoint(&weight), sizes);
            prepared.finish(state, y)
        }
        OpsKind::UnTracked(prepared) => prepared.finish(y),
    }
}

#[derive(Debug)]
struct WithBias;

impl Backward<Flex, 3> for WithBias {
    type State = State;

    fn backward(self, ops: Ops<State, 3>, gradients_of: &mut Gradients, checkpointer: &mut Checkpointer) {
        let dy = gradients_of.consume::<Flex>(&ops.node);
        let (x, weight, sizes) = ops.state;
        let x = checkpointer.retrieve_node_output::<Cpu>(x);
        let weight = checkpointer.retrieve_node_output::<Cpu>(weight);
        let [of_x, of_weight, of_bias] = ops.parents;
        let [dx, dw] = gradients(&sizes, [&x, &weight], &dy, [of_x.is_some(), of_weight.is_some()]);
        let db = of_bias.as_ref().map(|_| {
            let mut sums = vec![0.0; sizes.outputs];
            add_column_sums(compute().isa(), numbers(&channels_last(&dy)), &mut sums);
            tensor(sums, [sizes.outputs])
        });
        register(gradients_of, [of_x, of_weight, of_bias].map(|node| node.map(|node| node.id)), [dx, dw, db]);
    }
}

fn with_bias(x: CpuTrained, weight: CpuTrained, bias: CpuTrained, sizes: TrainingConvolution) -> CpuTrained {
    let y = forward(&sizes, x.primitive(), weight.primitive(), Some(bias.primitive()));
    let nodes = [x.node(), weight.node(), bias.node()];
    match WithBias.prepare::<NoCheckpointing>(nodes).compute_bound().stateful() {
        OpsKind::Tracked(mut prepared) => {
            let state = (prepared.checkpoint(&x), prepared.checkpoint(&weight), sizes);
            prepared.finish(state, y)
        }
        OpsKind::UnTracked(prepared) => prepared.finish(y),
    }
}
