//! Batch normalisation.

use std::sync::Arc;

use burn::backend::Flex;
use burn::backend::autodiff::NodeId;
use burn::backend::autodiff::checkpoint::base::Checkpointer;
use burn::backend::autodiff::checkpoint::strategy::NoCheckpointing;
use burn::backend::autodiff::grads::Gradients;
use burn::backend::autodiff::ops::{Backward, Ops, OpsKind};
use burn::nn::BatchNorm;
use burn::tensor::{Tensor, TensorData};
use opendr_kernels::{BatchNormalization, BatchStatistics, Unary};

use super::{
    Cpu, CpuTrained, Own, Trained, channels_last, channels_last_of, channels_second, compute,
    from_channels_last, numbers, register, shape, tensor,
};
use crate::layers::Activation;

/// Returns the normalisation of `[batch, channels, ...]`, as [`BatchNorm::forward`].
pub fn batch_norm<const D: usize>(layer: &BatchNorm, x: Tensor<D>) -> Tensor<D> {
    batch_norm_act(layer, Activation::Identity, x)
}

/// Returns the activation of the normalisation of `[batch, channels, ...]`.
pub fn batch_norm_act<const D: usize>(layer: &BatchNorm, activation: Activation, x: Tensor<D>) -> Tensor<D> {
    let own = activation.kernel().and_then(|kernel| match Own::of(&x)? {
        Own::Trained(own) if layer.training.is_enabled() => train(layer, &x, &own, kernel),
        Own::Trained(own) => frozen(layer, &own, kernel),
        Own::Plain(own) => {
            let parts =
                [layer.gamma.val(), layer.beta.val(), layer.running_mean.value(), layer.running_var.value()];
            let parts = parts.map(|part| part.try_into_primitive::<Flex>().ok());
            Some(Tensor::from_primitive::<Flex>(Fixed::of(parts, layer.epsilon, kernel)?.forward(&own)))
        }
    });
    own.unwrap_or_else(|| activation.apply(layer.forward(x)))
}

/// A normalisation by running statistics.
#[derive(Debug)]
struct Fixed {
    gamma: Vec<f32>,
    beta: Vec<f32>,
    statistics: BatchStatistics,
    epsilon: f32,
    activation: Unary,
}

impl Fixed {
    /// Creates it of gamma, beta, mean and variance.
    fn of(parts: [Option<Cpu>; 4], epsilon: f64, activation: Unary) -> Option<Self> {
        let parts = parts.map(|part| part.map(|part| numbers(&part.to_contiguous()).to_vec()));
        let [gamma, beta, mean, variance] = parts;
        let statistics = BatchStatistics { mean: mean?, variance: variance? };
        Some(Self { gamma: gamma?, beta: beta?, statistics, epsilon: epsilon as f32, activation })
    }

    fn norm(&self) -> BatchNormalization<'_> {
        let Self { gamma, beta, epsilon, activation, .. } = self;
        BatchNormalization { gamma, beta, epsilon: *epsilon, activation: *activation }
    }

    fn forward(&self, x: &Cpu) -> Cpu {
        let y = self.norm().inference(compute(), numbers(&channels_last(x)), &self.statistics);
        from_channels_last(y, &shape(x))
    }
}

/// Normalises by the running statistics, where the layer is not trained and the tensor has gradients.
fn frozen<const D: usize>(layer: &BatchNorm, x: &CpuTrained, activation: Unary) -> Option<Tensor<D>> {
    let parts = [layer.gamma.val(), layer.beta.val(), layer.running_mean.value(), layer.running_var.value()];
    let parts = parts.map(|part| {
        let part = part.try_into_primitive::<Trained>().ok()?;
        (!part.is_tracked()).then(|| part.into_primitive())
    });
    let fixed = Arc::new(Fixed::of(parts, layer.epsilon, activation)?);
    let y = fixed.forward(x.primitive());
    let y = match Frozen.prepare::<NoCheckpointing>([x.node()]).compute_bound().stateful() {
        OpsKind::Tracked(mut prepared) => {
            let input = prepared.checkpoint(x);
            prepared.finish((input, fixed), y)
        }
        OpsKind::UnTracked(prepared) => prepared.finish(y),
    };
    Some(Tensor::from_primitive::<Trained>(y))
}

#[derive(Debug)]
struct Frozen;

impl Backward<Flex, 1> for Frozen {
    type State = (NodeId, Arc<Fixed>);

    fn backward(self, ops: Ops<Self::State, 1>, gradients: &mut Gradients, checkpointer: &mut Checkpointer) {
        let mut dy = channels_last_of(gradients.consume::<Flex>(&ops.node));
        let ([parent], (x, fixed)) = (ops.parents, ops.state);
        let x = channels_last(&checkpointer.retrieve_node_output::<Cpu>(x));
        let Some(parent) = parent else { return };
        fixed.norm().inference_backward(compute(), numbers(&x), &fixed.statistics, dy.storage_mut());
        gradients.register::<Flex>(parent.id, channels_second(&dy));
    }
}

/// Normalises by the statistics of the batch, and updates the running ones.
fn train<const D: usize>(
    layer: &BatchNorm,
    x: &Tensor<D>,
    own: &CpuTrained,
    activation: Unary,
) -> Option<Tensor<D>> {
    let device = x.device();
    let gamma = layer.gamma.val().try_into_primitive::<Trained>().ok()?;
    let beta = layer.beta.val().try_into_primitive::<Trained>().ok()?;
    let epsilon = layer.epsilon as f32;
    let pixels = channels_last(own.primitive());
    let (of_gamma, of_beta) = (gamma.primitive().to_contiguous(), beta.primitive().to_contiguous());
    let norm = BatchNormalization { gamma: numbers(&of_gamma), beta: numbers(&of_beta), epsilon, activation };
    let (y, statistics) = norm.forward(compute(), numbers(&pixels));
    let statistics = Arc::new(statistics);
    let y = from_channels_last(y, &shape(own.primitive()));
    let nodes = [own.node(), gamma.node(), beta.node()];
    let y = match Normalized.prepare::<NoCheckpointing>(nodes).compute_bound().stateful() {
        OpsKind::Tracked(mut prepared) => {
            let inputs = [own, &gamma, &beta].map(|tensor| prepared.checkpoint(tensor));
            prepared.finish(State { inputs, statistics: Arc::clone(&statistics), epsilon, activation }, y)
        }
        OpsKind::UnTracked(prepared) => prepared.finish(y),
    };
    for (running, batch) in
        [(&layer.running_mean, &statistics.mean), (&layer.running_var, &statistics.variance)]
    {
        let batch = Tensor::<1>::from_data(TensorData::new(batch.clone(), [batch.len()]), &device);
        let value = running.value_sync().to_device(&device).mul_scalar(1.0 - layer.momentum);
        running.update(value.add(batch.mul_scalar(layer.momentum)).detach());
    }
    Some(Tensor::from_primitive::<Trained>(y))
}

#[derive(Debug, Clone)]
struct State {
    /// Input, gamma and beta.
    inputs: [NodeId; 3],
    statistics: Arc<BatchStatistics>,
    epsilon: f32,
    activation: Unary,
}

#[derive(Debug)]
struct Normalized;

impl Backward<Flex, 3> for Normalized {
    type State = State;

    fn backward(self, ops: Ops<State, 3>, gradients: &mut Gradients, checkpointer: &mut Checkpointer) {
        let mut dy = channels_last_of(gradients.consume::<Flex>(&ops.node));
        let State { inputs, statistics, epsilon, activation } = ops.state;
        let [x, gamma, beta] = inputs.map(|node| checkpointer.retrieve_node_output::<Cpu>(node));
        let pixels = channels_last(&x);
        let (gamma, beta) = (gamma.to_contiguous(), beta.to_contiguous());
        let norm = BatchNormalization { gamma: numbers(&gamma), beta: numbers(&beta), epsilon, activation };
        let [dgamma, dbeta] = norm.backward(compute(), numbers(&pixels), &statistics, dy.storage_mut());
        let vector = |gradient: Vec<f32>| {
            let channels = gradient.len();
            Some(tensor(gradient, [channels]))
        };
        let all = [Some(channels_second(&dy)), vector(dgamma), vector(dbeta)];
        register(gradients, ops.parents.map(|node| node.map(|node| node.id)), all);
    }
}
