//! Activation functions.

use burn::backend::Flex;
use burn::backend::autodiff::checkpoint::base::Checkpointer;
use burn::backend::autodiff::checkpoint::strategy::NoCheckpointing;
use burn::backend::autodiff::grads::Gradients;
use burn::backend::autodiff::ops::{Backward, Ops, OpsKind};
use burn::tensor::{Tensor, activation};
use opendr_kernels::Unary;

use super::{
    Cpu, Own, Trained, channels_last, channels_last_of, channels_second, compute, contiguous,
    from_channels_last, numbers, shape, tensor,
};

/// `min(max(x, 0), 6)`.
pub(crate) const RELU6: Unary = Unary::Clip { low: 0.0, high: 6.0 };

/// Returns `max(x, 0)`.
pub fn relu<const D: usize>(x: Tensor<D>) -> Tensor<D> {
    activate(Unary::Relu, &x).unwrap_or_else(|| activation::relu(x))
}

/// Returns `min(max(x, 0), 6)`.
pub fn relu6<const D: usize>(x: Tensor<D>) -> Tensor<D> {
    activate(RELU6, &x).unwrap_or_else(|| activation::relu6(x))
}

/// Returns the activation of a tensor on the CPU; `None` for others.
pub(crate) fn activate<const D: usize>(kernel: Unary, x: &Tensor<D>) -> Option<Tensor<D>> {
    let own = Own::of(x)?;
    let from = in_order(own.primitive());
    let mut y = vec![0.0; numbers(&from).len()];
    kernel.apply(compute(), numbers(&from), &mut y);
    let y = as_ordered(own.primitive(), y);
    let Own::Trained(x) = own else { return Some(Tensor::from_primitive::<Flex>(y)) };
    // The gradient depends on whether the input lies above a kink, as the output does, which the next layer keeps anyway.
    let has_kinks = matches!(kernel, Unary::Relu | Unary::Clip { .. } | Unary::LeakyRelu { .. });
    let kept = if has_kinks { y.clone() } else { x.primitive().clone() };
    let y = match Activated.prepare::<NoCheckpointing>([x.node()]).compute_bound().stateful() {
        OpsKind::Tracked(prepared) => prepared.finish((kept, kernel), y),
        OpsKind::UnTracked(prepared) => prepared.finish(y),
    };
    Some(Tensor::from_primitive::<Trained>(y))
}

/// Returns whether the numbers do not lie with channels last.
fn is_in_order(tensor: &Cpu) -> bool {
    tensor.as_slice::<f32>().is_some() || tensor.layout().num_dims() < 3
}

/// Returns the numbers in the order in which those of a tensor of images lie.
fn in_order(tensor: &Cpu) -> Cpu {
    if is_in_order(tensor) { tensor.to_contiguous() } else { channels_last(tensor) }
}

/// Returns numbers in the order of those of a tensor.
fn as_ordered(like: &Cpu, all: Vec<f32>) -> Cpu {
    if is_in_order(like) { tensor(all, shape(like)) } else { from_channels_last(all, &shape(like)) }
}

#[derive(Debug)]
struct Activated;

impl Backward<Flex, 1> for Activated {
    type State = (Cpu, Unary);

    fn backward(self, ops: Ops<(Cpu, Unary), 1>, gradients: &mut Gradients, _: &mut Checkpointer) {
        let dy = gradients.consume::<Flex>(&ops.node);
        let ([parent], (kept, kernel)) = (ops.parents, ops.state);
        let Some(parent) = parent else { return };
        let is_in_order = is_in_order(&kept);
        let mut dy = if is_in_order { contiguous(dy) } else { channels_last_of(dy) };
        kernel.backward(compute(), numbers(&in_order(&kept)), dy.storage_mut());
        gradients.register::<Flex>(parent.id, if is_in_order { dy } else { channels_second(&dy) });
    }
}
