//! Convolutions of images.

use burn::backend::Flex;
use burn::backend::autodiff::NodeId;
use burn::backend::autodiff::checkpoint::base::Checkpointer;
use burn::backend::autodiff::checkpoint::strategy::NoCheckpointing;
use burn::backend::autodiff::grads::Gradients;
use burn::backend::autodiff::ops::{Backward, Ops, OpsKind};
use burn::nn::PaddingConfig2d;
use burn::nn::conv::Conv2d;
use burn::tensor::{DType, Tensor};
use opendr_kernels::{TrainingConvolution, Window, add_column_sums};

use super::{Cpu, CpuTrained, Trained, channels_last, compute, from_channels_last, numbers, shape, tensor};

/// Returns the convolution of images `[batch, channels, height, width]`, as [`Conv2d::forward`].
pub fn conv2d(layer: &Conv2d, x: Tensor<4>) -> Tensor<4> {
    let Some(sizes) = sizes(layer, &x) else { return layer.forward(x) };
    let (weight, bias) = (layer.weight.val(), layer.bias.as_ref().map(|bias| bias.val()));
    let parts = [x.clone().try_into_primitive::<Trained>(), weight.clone().try_into_primitive::<Trained>()];
    if let [Ok(x), Ok(weight)] = parts {
        return match bias.map(|bias| bias.try_into_primitive::<Trained>()) {
            None => Tensor::from_primitive::<Trained>(without_bias(x, weight, sizes)),
            Some(Ok(bias)) => Tensor::from_primitive::<Trained>(with_bias(x, weight, bias, sizes)),
            Some(Err(_)) => layer.forward(Tensor::from_primitive::<Trained>(x)),
        };
    }
    let parts = [x.clone().try_into_primitive::<Flex>(), weight.try_into_primitive::<Flex>()];
    let bias = bias.map(|bias| bias.try_into_primitive::<Flex>()).transpose();
    match (parts, bias) {
        ([Ok(x), Ok(weight)], Ok(bias)) => {
            Tensor::from_primitive::<Flex>(forward(&sizes, &x, &weight, bias.as_ref()))
        }
        _ => layer.forward(x),
    }
}

/// Returns the sizes, where the kernels compute them.
fn sizes(layer: &Conv2d, x: &Tensor<4>) -> Option<TrainingConvolution> {
    let [batch, channels, height, width] = x.dims();
    let pads = match layer.padding {
        PaddingConfig2d::Valid => [0; 4],
        PaddingConfig2d::Explicit(top, left, bottom, right) => [top, left, bottom, right],
        PaddingConfig2d::Same => return None,
    };
    let [outputs, _, kernel_height, kernel_width] = layer.weight.dims();
    let (kernel, input) = ([kernel_height, kernel_width], [height, width]);
    let size = |axis: usize| {
        let span = (kernel[axis] - 1) * layer.dilation[axis] + 1;
        let last = (input[axis] + pads[axis] + pads[axis + 2]).checked_sub(span)?;
        Some(last / layer.stride[axis] + 1)
    };
    let window = Window {
        kernel,
        strides: layer.stride,
        dilations: layer.dilation,
        pads: [pads[0], pads[1]],
        input,
        output: [size(0)?, size(1)?],
    };
    let is_computed = x.dtype() == DType::F32 && layer.weight.dims()[1] * layer.groups == channels;
    is_computed.then_some(TrainingConvolution { batch, channels, outputs, groups: layer.groups, window })
}

fn forward(sizes: &TrainingConvolution, x: &Cpu, weight: &Cpu, bias: Option<&Cpu>) -> Cpu {
    let (x, weight) = (channels_last(x), weight.to_contiguous());
    let bias = bias.map(Cpu::to_contiguous);
    let y = sizes.forward(compute(), numbers(&x), numbers(&weight), bias.as_ref().map(numbers));
    let [height, width] = sizes.window.output;
    from_channels_last(y, &[sizes.batch, sizes.outputs, height, width])
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
        for (node, gradient) in ops.parents.into_iter().zip(all) {
            if let (Some(node), Some(gradient)) = (node, gradient) {
                gradients_of.register::<Flex>(node.id, gradient);
            }
        }
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
        for (node, gradient) in [(of_x, dx), (of_weight, dw), (of_bias, db)] {
            if let (Some(node), Some(gradient)) = (node, gradient) {
                gradients_of.register::<Flex>(node.id, gradient);
            }
        }
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
