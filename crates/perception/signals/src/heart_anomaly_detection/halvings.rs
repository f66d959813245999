//! Convolutions that shorten a heart signal.

use burn::module::Module;
use burn::nn::conv::{Conv1d, Conv1dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, PaddingConfig1d};
use burn::tensor::activation::relu;
use burn::tensor::{Device, Tensor};

/// Most steps that are left.
const MOST_STEPS: usize = 64;
/// Channels of the convolutions.
const CHANNELS: usize = 32;
/// Instants that a convolution sees.
const KERNEL: usize = 7;

/// As many convolutions with stride two as it takes to leave at most 64 steps; `[batch, features, time]` to
/// `[batch, channels, steps]`.
#[derive(Module, Debug)]
pub struct Halvings {
    layers: Vec<Halving>,
}

/// A convolution with stride two, normalised and rectified.
#[derive(Module, Debug)]
struct Halving {
    convolution: Conv1d,
    norm: BatchNorm,
}

impl Halvings {
    /// The layers for series of `[time, features]`, with weights as training begins with, and the `[steps, channels]`
    /// that they leave.
    pub fn new([time, features]: [usize; 2], device: &Device) -> (Self, [usize; 2]) {
        let (mut layers, mut steps, mut channels) = (Vec::new(), time, features);
        while steps > MOST_STEPS {
            layers.push(Halving::new(channels, device));
            (steps, channels) = (steps.div_ceil(2), CHANNELS);
        }
        (Self { layers }, [steps, channels])
    }

    /// What they leave of a signal.
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
        relu(self.norm.forward(self.convolution.forward(signal)))
    }
}
