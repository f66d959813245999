//! The trained network.

use burn::module::Module;
use burn::nn::pool::{MaxPool2d, MaxPool2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, Dropout, DropoutConfig, Linear, LinearConfig};
use burn::tensor::{Device, Tensor};
use opendr_training::operations::batch_norm;

use super::QuadraticSelfOnnKind;
use super::quadratic_convolution::QuadraticConvolution;
use crate::speech_recognition::cepstra::FRAMES;
use crate::speech_recognition::word_learner::WordKind as _;

/// Number of channels of both layers.
const CHANNELS: usize = 20;

/// Network from `[batch, coefficients, frames]` to logits `[batch, classes]`.
#[derive(Module, Debug)]
pub struct QuadraticSelfOnnNetwork {
    /// Normalisation of each coefficient by the training data.
    scale: BatchNorm,
    first: QuadraticConvolution,
    second: QuadraticConvolution,
    pool: MaxPool2d,
    dropout: Dropout,
    classifier: Linear,
}

impl QuadraticSelfOnnNetwork {
    /// Returns a network with initial weights.
    pub fn new(order: usize, classes: usize, dropout: f64, device: &Device) -> Self {
        let features = CHANNELS * (QuadraticSelfOnnKind::COEFFICIENTS / 4) * (FRAMES / 4);
        Self {
            scale: BatchNormConfig::new(QuadraticSelfOnnKind::COEFFICIENTS).init(device),
            first: QuadraticConvolution::new([1, CHANNELS], order, device),
            second: QuadraticConvolution::new([CHANNELS, CHANNELS], order, device),
            pool: MaxPool2dConfig::new([2, 2]).with_strides([2, 2]).init(),
            dropout: DropoutConfig::new(dropout).init(),
            classifier: LinearConfig::new(features, classes).init(device),
        }
    }

    /// Returns logits `[batch, classes]` of cepstra `[batch, coefficients, frames]`.
    pub fn forward(&self, cepstra: Tensor<3>) -> Tensor<2> {
        let [batch, coefficients, frames] = cepstra.dims();
        let picture = batch_norm(&self.scale, cepstra).reshape([batch, 1, coefficients, frames]);
        let features = self.pool.forward(self.first.forward(picture)).tanh();
        let features = self.pool.forward(self.second.forward(features)).tanh();
        let [_, channels, height, width] = features.dims();
        let features = features.reshape([batch, channels * height * width]);
        self.classifier.forward(self.dropout.forward(features))
    }
}
