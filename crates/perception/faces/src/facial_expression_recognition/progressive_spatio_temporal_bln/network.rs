//! PST-BLN's network for training.

use burn::module::{Initializer, Module, Param};
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, Dropout, DropoutConfig, Linear, LinearConfig, PaddingConfig2d};
use burn::tensor::{Device, Tensor};
use opendr_training::layers::Activation;
use opendr_training::operations::{add_act, batch_norm, batch_norm_act, conv2d};

/// Kernel size over time, in frames.
const KERNEL: usize = 9;

/// Sizes of the network.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NetworkSizes {
    /// Features of a landmark.
    pub features: usize,
    /// Frames of a clip.
    pub frames: usize,
    /// Number of landmarks.
    pub points: usize,
    /// Channels of each layer.
    pub channels: Vec<usize>,
}

/// A network from `[batch, features, frames, landmarks]` to logits `[batch, classes]`.
#[derive(Module, Debug)]
pub(super) struct BilinearNetwork {
    scale: BatchNorm,
    layers: Vec<Bilinear>,
    dropout: Dropout,
    classifier: Linear,
}

/// A layer: a mixture of all landmarks in each frame, a convolution over time at each landmark, and a residual connection.
#[derive(Module, Debug)]
struct Bilinear {
    landmarks: Param<Tensor<2>>,
    channels: Conv2d,
    channels_norm: BatchNorm,
    time: Conv2d,
    time_norm: BatchNorm,
    past: Conv2d,
    dropout: Dropout,
}

impl BilinearNetwork {
    /// Creates a network with random weights.
    pub fn new(sizes: &NetworkSizes, classes: usize, dropout: f64, device: &Device) -> Self {
        let mut inputs = sizes.features;
        let layers = sizes.channels.iter().map(|channels| {
            let layer = Bilinear::new([inputs, *channels], sizes.points, dropout, device);
            inputs = *channels;
            layer
        });
        let layers = layers.collect();
        Self {
            scale: BatchNormConfig::new(sizes.features).init(device),
            layers,
            dropout: DropoutConfig::new(dropout).init(),
            classifier: LinearConfig::new(inputs, classes).init(device),
        }
    }

    /// Computes logits `[batch, classes]` of clips `[batch, features, frames, landmarks]`.
    pub fn forward(&self, clips: Tensor<4>) -> Tensor<2> {
        let signal = batch_norm(&self.scale, clips);
        let signal = self.layers.iter().fold(signal, |signal, layer| layer.forward(signal));
        let [batch, channels, frames, points] = signal.dims();
        let pooled =
            signal.reshape([batch, channels, frames * points]).mean_dim(2).reshape([batch, channels]);
        self.classifier.forward(self.dropout.forward(pooled))
    }
}

impl Bilinear {
    fn new([inputs, outputs]: [usize; 2], points: usize, dropout: f64, device: &Device) -> Self {
        let convolution = |inputs: usize, kernel: usize| {
            Conv2dConfig::new([inputs, outputs], [kernel, 1])
                .with_padding(PaddingConfig2d::Explicit(kernel / 2, 0, kernel / 2, 0))
                .with_bias(false)
                .init(device)
        };
        let norm = || BatchNormConfig::new(outputs).init(device);
        // Initially each landmark has itself and a small share of all others.
        let others = Initializer::Constant { value: 0.1 / points as f64 }.init([points, points], device);
        let landmarks = others.map(|others: Tensor<2>| others + Tensor::eye(points, device));
        Self {
            landmarks,
            channels: convolution(inputs, 1),
            channels_norm: norm(),
            time: convolution(outputs, KERNEL),
            time_norm: norm(),
            past: convolution(inputs, 1),
            dropout: DropoutConfig::new(dropout).init(),
        }
    }

    fn forward(&self, signal: Tensor<4>) -> Tensor<4> {
        let [batch, channels, frames, points] = signal.dims();
        let rows = signal.clone().reshape([batch * channels * frames, points]);
        let mixed = rows.matmul(self.landmarks.val()).reshape([batch, channels, frames, points]);
        let mixed = batch_norm_act(&self.channels_norm, Activation::Relu, conv2d(&self.channels, mixed));
        let moved = batch_norm(&self.time_norm, conv2d(&self.time, mixed));
        add_act(self.dropout.forward(moved), conv2d(&self.past, signal), Activation::Relu)
    }
}
