//! The trained network.

use burn::module::{Initializer, Module, Param};
use burn::nn::{Dropout, DropoutConfig, Linear, LinearConfig};
use burn::tensor::activation::relu;
use burn::tensor::{Device, Tensor};

use super::attention::Attention;
use super::{AttentionNeuralBagOfFeatureParams, QuantizationType};
use crate::heart_anomaly_detection::HeartSizes;
use crate::heart_anomaly_detection::halvings::Halvings;

/// Number of features between the bag and the classifier.
const HIDDEN: usize = 512;

/// Network from `[batch, time, features]` to logits `[batch, classes]`.
#[derive(Module, Debug)]
pub struct AttentionNeuralBagOfFeatureNetwork {
    halvings: Halvings,
    codebook: Linear,
    scale: Param<Tensor<1>>,
    /// One attention layer for each part of the sequence.
    parts: Vec<Attention>,
    hidden: Linear,
    dropout: Dropout,
    classifier: Linear,
}

impl AttentionNeuralBagOfFeatureNetwork {
    /// Returns a network with initial weights.
    pub fn new(params: &AttentionNeuralBagOfFeatureParams, sizes: &HeartSizes, device: &Device) -> Self {
        let (halvings, [steps, channels]) = Halvings::new(sizes.shape, device);
        let words = params.n_codeword;
        let parts = match params.quantization_type {
            QuantizationType::Nbof => vec![steps],
            QuantizationType::Tnbof => vec![steps, steps - steps / 2],
        };
        Self {
            halvings,
            codebook: LinearConfig::new(channels, words).init(device),
            scale: Initializer::Ones.init([1], device),
            hidden: LinearConfig::new(words * parts.len(), HIDDEN).init(device),
            parts: parts
                .into_iter()
                .map(|steps| Attention::new(params.attention_type, [steps, words], device))
                .collect(),
            dropout: DropoutConfig::new(sizes.dropout).init(),
            classifier: LinearConfig::new(HIDDEN, sizes.classes).init(device),
        }
    }

    /// Returns logits `[batch, classes]` of series `[batch, time, features]`.
    pub fn forward(&self, series: Tensor<3>) -> Tensor<2> {
        let steps = self.halvings.forward(series.swap_dims(1, 2)).swap_dims(1, 2);
        let likeness = self.codebook.forward(steps) * self.scale.val().reshape([1, 1, 1]);
        let words = (likeness.tanh() + 1.0) / 2.0;
        let [batch, length, count] = words.dims();
        let bags = self.parts.iter().enumerate().map(|(index, attention)| {
            let begin = if index == 0 { 0 } else { length / 2 };
            let part = attention.forward(words.clone().narrow(1, begin, length - begin));
            part.mean_dim(1).reshape([batch, count])
        });
        let bag = Tensor::cat(bags.collect(), 1);
        self.classifier.forward(self.dropout.forward(relu(self.hidden.forward(bag))))
    }
}
