//! The trained network.

use burn::module::Module;
use burn::nn::conv::{Conv1d, Conv1dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, Dropout, DropoutConfig, Linear, LinearConfig, PaddingConfig1d};
use burn::tensor::{Device, Tensor};
use opendr_training::layers::Activation;
use opendr_training::operations::{add_act, batch_norm, conv1d, relu};

use super::MatchboxNetKind;
use crate::speech_recognition::word_learner::WordKind as _;

/// Sizes of the network.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NetworkSizes {
    /// Number of residual blocks (B).
    pub blocks: usize,
    /// Number of convolutions per block (R).
    pub subblocks: usize,
    /// Number of channels of the blocks (C).
    pub channels: usize,
    /// Number of classes.
    pub classes: usize,
    /// Dropout probability.
    pub dropout: f64,
}

const COEFFICIENTS: usize = MatchboxNetKind::COEFFICIENTS;
/// Channels before and after the blocks.
const OUTER_CHANNELS: usize = 128;

/// Network from `[batch, coefficients, frames]` to logits `[batch, classes]` (figure 1 and table 1 of the paper).
#[derive(Module, Debug)]
pub struct MatchboxNetNetwork {
    /// Normalisation of each coefficient by the training data.
    scale: BatchNorm,
    prologue: Separable,
    blocks: Vec<Block>,
    epilogue: Separable,
    mixing: Pointwise,
    dropout: Dropout,
    classifier: Linear,
}

/// Separable convolutions with a residual connection.
#[derive(Module, Debug)]
struct Block {
    convolutions: Vec<Separable>,
    past: Pointwise,
    dropout: Dropout,
}

/// A depthwise convolution through time followed by a pointwise one over channels; normalised.
#[derive(Module, Debug)]
struct Separable {
    depthwise: Conv1d,
    pointwise: Pointwise,
}

/// A pointwise convolution over channels; normalised.
#[derive(Module, Debug)]
struct Pointwise {
    convolution: Conv1d,
    norm: BatchNorm,
}

impl MatchboxNetNetwork {
    /// Returns a network with initial weights.
    pub fn new(sizes: &NetworkSizes, device: &Device) -> Self {
        let NetworkSizes { blocks, subblocks, channels, classes, dropout } = *sizes;
        let block = |index: usize| {
            let channels_in = if index == 0 { OUTER_CHANNELS } else { channels };
            let separable = |sub: usize| {
                let channels_in = if sub == 0 { channels_in } else { channels };
                Separable::new([channels_in, channels], 13 + 2 * index, 1, device)
            };
            Block {
                convolutions: (0..subblocks).map(separable).collect(),
                past: Pointwise::new([channels_in, channels], device),
                dropout: DropoutConfig::new(dropout).init(),
            }
        };
        Self {
            scale: BatchNormConfig::new(COEFFICIENTS).init(device),
            prologue: Separable::new([COEFFICIENTS, OUTER_CHANNELS], 11, 1, device),
            blocks: (0..blocks).map(block).collect(),
            epilogue: Separable::new([channels, OUTER_CHANNELS], 29, 2, device),
            mixing: Pointwise::new([OUTER_CHANNELS; 2], device),
            dropout: DropoutConfig::new(dropout).init(),
            classifier: LinearConfig::new(OUTER_CHANNELS, classes).init(device),
        }
    }

    /// Returns logits `[batch, classes]` of cepstra `[batch, coefficients, frames]`.
    pub fn forward(&self, cepstra: Tensor<3>) -> Tensor<2> {
        let signal = relu(self.prologue.forward(batch_norm(&self.scale, cepstra)));
        let signal = self.blocks.iter().fold(signal, |signal, block| block.forward(signal));
        let signal = self.dropout.forward(relu(self.epilogue.forward(signal)));
        let signal = self.dropout.forward(relu(self.mixing.forward(signal)));
        // The paper's last convolution and its mean over time are exchanged: both are linear.
        let [batch, channels, _] = signal.dims();
        self.classifier.forward(signal.mean_dim(2).reshape([batch, channels]))
    }
}

impl Block {
    fn forward(&self, signal: Tensor<3>) -> Tensor<3> {
        let past = self.past.forward(signal.clone());
        let last = self.convolutions.len() - 1;
        let convolved = self.convolutions.iter().enumerate().fold(signal, |signal, (index, convolution)| {
            let convolved = convolution.forward(signal);
            if index < last { self.dropout.forward(relu(convolved)) } else { convolved }
        });
        self.dropout.forward(add_act(convolved, past, Activation::Relu))
    }
}

impl Separable {
    fn new([channels_in, channels]: [usize; 2], kernel: usize, dilation: usize, device: &Device) -> Self {
        let reach = dilation * (kernel / 2);
        let depthwise = Conv1dConfig::new(channels_in, channels_in, kernel)
            .with_groups(channels_in)
            .with_dilation(dilation)
            .with_padding(PaddingConfig1d::Explicit(reach, reach))
            .with_bias(false);
        Self { depthwise: depthwise.init(device), pointwise: Pointwise::new([channels_in, channels], device) }
    }

    fn forward(&self, signal: Tensor<3>) -> Tensor<3> {
        self.pointwise.forward(self.depthwise.forward(signal))
    }
}

impl Pointwise {
    fn new([channels_in, channels]: [usize; 2], device: &Device) -> Self {
        let convolution = Conv1dConfig::new(channels_in, channels, 1).with_bias(false);
        Self { convolution: convolution.init(device), norm: BatchNormConfig::new(channels).init(device) }
    }

    fn forward(&self, signal: Tensor<3>) -> Tensor<3> {
        batch_norm(&self.norm, conv1d(&self.convolution, signal))
    }
}
