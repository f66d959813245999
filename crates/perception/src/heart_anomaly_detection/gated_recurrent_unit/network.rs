//! The network as it is trained.

use burn::module::Module;
use burn::nn::conv::{Conv1d, Conv1dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, Dropout, DropoutConfig, Linear, LinearConfig, PaddingConfig1d};
use burn::tensor::activation::relu;
use burn::tensor::{Device, Tensor};
use opendr_training::layers::{Gru, GruConfig};

/// Sizes of the network.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NetworkSizes {
    /// Features of a series.
    pub features: usize,
    /// Instants of a series.
    pub time: usize,
    /// Classes.
    pub classes: usize,
    /// Features of the unit's state.
    pub hidden: usize,
    /// Share of the state's features that are left out in training.
    pub dropout: f64,
}

/// Most steps that the unit is given: beyond, it forgets the beginning and training becomes slow.
const MOST_STEPS: usize = 64;
/// Channels of the convolutions.
const CHANNELS: usize = 32;
/// Instants that a convolution sees.
const KERNEL: usize = 7;

/// `[batch, time, features]` to logits `[batch, classes]`.
#[derive(Module, Debug)]
pub struct GatedRecurrentUnitNetwork {
    halvings: Vec<Halving>,
    unit: Gru,
    dropout: Dropout,
    classifier: Linear,
}

/// A convolution with stride two, normalised and rectified.
#[derive(Module, Debug)]
struct Halving {
    convolution: Conv1d,
    norm: BatchNorm,
}

impl GatedRecurrentUnitNetwork {
    /// A network with weights as training begins with.
    pub fn new(sizes: &NetworkSizes, device: &Device) -> Self {
        let NetworkSizes { features, time, classes, hidden, dropout } = *sizes;
        let (mut halvings, mut steps, mut channels) = (Vec::new(), time, features);
        while steps > MOST_STEPS {
            halvings.push(Halving::new(channels, device));
            (steps, channels) = (steps.div_ceil(2), CHANNELS);
        }
        Self {
            halvings,
            unit: GruConfig::new(channels, hidden).init(device),
            dropout: DropoutConfig::new(dropout).init(),
            classifier: LinearConfig::new(hidden, classes).init(device),
        }
    }

    /// Logits `[batch, classes]` of series `[batch, time, features]`.
    pub fn forward(&self, series: Tensor<3>) -> Tensor<2> {
        let steps = match self.halvings.is_empty() {
            true => series,
            false => {
                let signal = series.swap_dims(1, 2);
                self.halvings.iter().fold(signal, |signal, halving| halving.forward(signal)).swap_dims(1, 2)
            }
        };
        self.classifier.forward(self.dropout.forward(self.unit.last(steps)))
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
