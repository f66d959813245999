//! The network for training.

use burn::module::Module;
use burn::nn::{Dropout, DropoutConfig, Linear, LinearConfig};
use burn::tensor::activation::relu;
use burn::tensor::{Device, Tensor};

/// Sizes of the network.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NetworkSizes {
    /// Number of input features.
    pub numbers: usize,
    /// Number of classes.
    pub classes: usize,
    /// Features of the first layer.
    pub hidden: usize,
    /// Dropout probability.
    pub dropout: f64,
}

/// A network from `[batch, numbers]` to logits `[batch, classes]`.
#[derive(Module, Debug)]
pub struct KeypointGestureNetwork {
    first: Linear,
    second: Linear,
    dropout: Dropout,
    classifier: Linear,
}

impl KeypointGestureNetwork {
    /// Creates a network with random weights.
    pub(super) fn new(sizes: &NetworkSizes, device: &Device) -> Self {
        let NetworkSizes { numbers, classes, hidden, dropout } = *sizes;
        let half = hidden.div_ceil(2);
        Self {
            first: LinearConfig::new(numbers, hidden).init(device),
            second: LinearConfig::new(hidden, half).init(device),
            dropout: DropoutConfig::new(dropout).init(),
            classifier: LinearConfig::new(half, classes).init(device),
        }
    }

    /// Computes logits `[batch, classes]` of rows `[batch, numbers]`.
    pub fn forward(&self, points: Tensor<2>) -> Tensor<2> {
        let first = self.dropout.forward(relu(self.first.forward(points)));
        self.classifier.forward(relu(self.second.forward(first)))
    }
}
