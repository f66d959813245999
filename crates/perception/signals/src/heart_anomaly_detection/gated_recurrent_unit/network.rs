//! The trained network.

use burn::module::Module;
use burn::nn::{Dropout, DropoutConfig, Linear, LinearConfig};
use burn::tensor::{Device, Tensor};
use opendr_training::layers::{Gru, GruConfig};

use crate::heart_anomaly_detection::HeartSizes;
use crate::heart_anomaly_detection::halvings::Halvings;

/// Network from `[batch, time, features]` to logits `[batch, classes]`.
#[derive(Module, Debug)]
pub struct GatedRecurrentUnitNetwork {
    halvings: Halvings,
    unit: Gru,
    dropout: Dropout,
    classifier: Linear,
}

impl GatedRecurrentUnitNetwork {
    /// Returns a network with initial weights and a state of `hidden` features.
    pub fn new(sizes: &HeartSizes, hidden: usize, device: &Device) -> Self {
        let (halvings, [_, channels]) = Halvings::new(sizes.shape, device);
        Self {
            halvings,
            unit: GruConfig::new(channels, hidden).init(device),
            dropout: DropoutConfig::new(sizes.dropout).init(),
            classifier: LinearConfig::new(hidden, sizes.classes).init(device),
        }
    }

    /// Returns logits `[batch, classes]` of series `[batch, time, features]`.
    pub fn forward(&self, series: Tensor<3>) -> Tensor<2> {
        let steps = self.halvings.forward(series.swap_dims(1, 2)).swap_dims(1, 2);
        self.classifier.forward(self.dropout.forward(self.unit.last(steps)))
    }
}
