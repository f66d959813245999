//! Strided convolutions that shorten a heart signal.

use burn::module::Module;
use burn::nn::conv::{Conv1d, Conv1dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, PaddingConfig1d};
use burn::tensor::{Device, Tensor};
use opendr_training::layers::Activation;
use opendr_training::operations::{batch_norm_act, conv1d};

/// Maximum number of remaining steps.
const MOST_STEPS: usize = 64;
/// Number of channels of the convolutions.
const CHANNELS: usize = 32;
/// Kernel size in time.
const KERNEL: usize = 7;

/// Convolutions of stride two, as many as leave at most 64 steps; `[batch, features, time]` to `[batch, channels, steps]`.
#[derive(Module, Debug)]
pub struct Halvings {
    layers: Vec<Halving>,
}

/// A convolution of stride two with normalisation and ReLU.
#[derive(Module, Debug)]
struct Halving {
    convolution: Conv1d,
    norm: BatchNorm,
}

impl Halvings {
    /// Returns the layers for series of `[time, features]`, with initial weights, and the `[steps, channels]` of their output.
    pub fn new([time, features]: [usize; 2], device: &Device) -> (Self, [usize; 2]) {
        let (mut layers, mut steps, mut channels) = (Vec::new(), time, features);
        while steps > MOST_STEPS {
            layers.push(Halving::new(channels, device));
            (steps, channels) = (steps.div_ceil(2), CHANNELS);
        }
        (Self { layers }, [steps, channels])
    }

    /// Returns the shortened signal.
    pub fn forward(&self, signal: Tensor<3>) -> Tensor<3> {
        self.layers.iter().fold(signal, |signal, layer| layer.forward(signal))
    }
}

impl Halving {
    fn new(channels: usize, device: &Device) -> Self {
        let convolution = Conv1dConfig::new(channels, CHANNELS, KERNEL)
            .with_stride(2)
            .with_padding(PaddingConfig1d::Explicit(KERNEL / 2, KERNEL / 2))
            .with_bias(false);
        Self { convolution: convolution.init(device), norm: BatchNormConfig::new(CHANNELS).init(device) }
    }

    fn forward(&self, signal: Tensor<3>) -> Tensor<3> {
        batch_norm_act(&self.norm, Activation::Relu, conv1d(&self.convolution, signal))
    }
}
