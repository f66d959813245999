//! Sums of two branches.

use burn::backend::Flex;
use burn::backend::autodiff::checkpoint::base::Checkpointer;
use burn::backend::autodiff::checkpoint::strategy::NoCheckpointing;
use burn::backend::autodiff::grads::Gradients;
use burn::backend::autodiff::ops::{Backward, Ops, OpsKind};
use burn::tensor::Tensor;
use opendr_kernels::{Unary, add_activated};

use super::{
    Cpu, Own, Trained, channels_last, channels_last_of, channels_second, compute, from_channels_last,
    numbers, shape,
};
use crate::layers::Activation;

/// Returns the activation of the sum of two tensors `[batch, channels, ...]`.
pub fn add_act<const D: usize>(left: Tensor<D>, right: Tensor<D>, activation: Activation) -> Tensor<D> {
    own(&left, &right, activation).unwrap_or_else(|| activation.apply(left + right))
}

/// Returns the sum where both tensors lie on the CPU, and the gradient follows from the output.
fn own<const D: usize>(left: &Tensor<D>, right: &Tensor<D>, activation: Activation) -> Option<Tensor<D>> {
    let kernel = activation.kernel().filter(|kernel| {
        matches!(kernel, Unary::Identity | Unary::Relu | Unary::Clip { .. } | Unary::LeakyRelu { .. })
    })?;
    if left.dims() != right.dims() {
        return None;
    }
    let (left, right) = (Own::of(left)?, Own::of(right)?);
    let (a, b) = (channels_last(left.primitive()), channels_last(right.primitive()));
    let y = add_activated(compute(), numbers(&a), numbers(&b), kernel);
    let y = from_channels_last(y, &shape(left.primitive()));
    let (left, right) = match (left, right) {
        (Own::Trained(left), Own::Trained(right)) => (left, right),
        (Own::Plain(_), Own::Plain(_)) => return Some(Tensor::from_primitive::<Flex>(y)),
        _ => return None,
    };
    let y = match Added.prepare::<NoCheckpointing>([left.node(), right.node()]).compute_bound().stateful() {
        OpsKind::Tracked(prepared) => prepared.finish((y.clone(), kernel), y),
        OpsKind::UnTracked(prepared) => prepared.finish(y),
    };
    Some(Tensor::from_primitive::<Trained>(y))
}

#[derive(Debug)]
struct Added;

impl Backward<Flex, 2> for Added {
    type State = (Cpu, Unary);

    fn backward(self, ops: Ops<(Cpu, Unary), 2>, gradients: &mut Gradients, _: &mut Checkpointer) {
        let mut dy = channels_last_of(gradients.consume::<Flex>(&ops.node));
        let (y, kernel) = ops.state;
        kernel.backward(compute(), numbers(&channels_last(&y)), dy.storage_mut());
        let dy = channels_second(&dy);
        for node in ops.parents.into_iter().flatten() {
            gradients.register::<Flex>(node.id, dy.clone());
        }
    }
}
