//! The trained networks.

use burn::module::Module;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::pool::{AvgPool2d, AvgPool2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, Dropout, DropoutConfig, Linear, LinearConfig, PaddingConfig2d};
use burn::tensor::{Device, Tensor};
use opendr_training::operations::{batch_norm, conv2d, relu};

use super::{EdgeSpeechNet, EdgeSpeechNetsKind};
use crate::speech_recognition::word_learner::WordKind as _;

/// Number of features before the classifier.
const FEATURES: usize = 45;

impl EdgeSpeechNet {
    /// Returns the channels between the blocks and those within each block.
    fn channels(self) -> (usize, &'static [usize]) {
        match self {
            Self::A => (39, &[20, 15, 25, 22, 22, 25]),
            Self::B => (30, &[8, 9, 11, 10, 8, 11]),
            Self::C => (24, &[6, 9, 12, 6, 5, 6, 2]),
            Self::D => (FEATURES, &[30, 33, 35]),
        }
    }
}

/// Network from `[batch, coefficients, frames]` to logits `[batch, classes]` (tables 1 to 4 of the paper).
#[derive(Module, Debug)]
pub struct EdgeSpeechNetsNetwork {
    /// Normalisation of each coefficient by the training data.
    scale: BatchNorm,
    first: Conv2d,
    pool: Option<AvgPool2d>,
    blocks: Vec<Block>,
    /// Last convolution; network D has none.
    last: Option<Conv2d>,
    dropout: Dropout,
    classifier: Linear,
}

/// Two convolutions with a residual connection.
#[derive(Module, Debug)]
struct Block {
    /// Normalisation before the block; the first block has none.
    before: Option<BatchNorm>,
    inner: Conv2d,
    between: BatchNorm,
    outer: Conv2d,
}

impl EdgeSpeechNetsNetwork {
    /// Returns a network with initial weights.
    pub fn new(architecture: EdgeSpeechNet, classes: usize, dropout: f64, device: &Device) -> Self {
        let (channels, inner) = architecture.channels();
        let halved = architecture == EdgeSpeechNet::D;
        let block = |(index, inner): (usize, &usize)| Block {
            before: (index > 0).then(|| BatchNormConfig::new(channels).init(device)),
            inner: convolution([channels, *inner], device),
            between: BatchNormConfig::new(*inner).init(device),
            outer: convolution([*inner, channels], device),
        };
        Self {
            scale: BatchNormConfig::new(EdgeSpeechNetsKind::COEFFICIENTS).init(device),
            first: convolution([1, channels], device),
            pool: halved.then(|| AvgPool2dConfig::new([2, 2]).with_strides([2, 2]).init()),
            blocks: inner.iter().enumerate().map(block).collect(),
            last: (!halved).then(|| convolution([channels, FEATURES], device)),
            dropout: DropoutConfig::new(dropout).init(),
            classifier: LinearConfig::new(FEATURES, classes).init(device),
        }
    }

    /// Returns logits `[batch, classes]` of cepstra `[batch, coefficients, frames]`.
    pub fn forward(&self, cepstra: Tensor<3>) -> Tensor<2> {
        let [batch, coefficients, frames] = cepstra.dims();
        let picture = batch_norm(&self.scale, cepstra).reshape([batch, 1, coefficients, frames]);
        let features = relu(conv2d(&self.first, picture));
        let features = match &self.pool {
            Some(pool) => pool.forward(features),
            None => features,
        };
        let features = self.blocks.iter().fold(features, |features, block| block.forward(features));
        let features = match &self.last {
            Some(last) => relu(conv2d(last, features)),
            None => features,
        };
        let [_, channels, height, width] = features.dims();
        let means = features.reshape([batch, channels, height * width]).mean_dim(2);
        self.classifier.forward(self.dropout.forward(means.reshape([batch, channels])))
    }
}

impl Block {
    fn forward(&self, features: Tensor<4>) -> Tensor<4> {
        let inner = match &self.before {
            Some(before) => before.forward(features.clone()),
            None => features.clone(),
        };
        let inner = batch_norm(&self.between, relu(conv2d(&self.inner, inner)));
        relu(conv2d(&self.outer, inner)) + features
    }
}

fn convolution(channels: [usize; 2], device: &Device) -> Conv2d {
    Conv2dConfig::new(channels, [3, 3])
        .with_padding(PaddingConfig2d::Explicit(1, 1, 1, 1))
        .with_bias(false)
        .init(device)
}
