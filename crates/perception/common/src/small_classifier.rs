//! A small image classifier.

use burn::module::Module;
use burn::nn::{Dropout, DropoutConfig, Linear, LinearConfig};
use burn::tensor::{Device, Tensor};

use crate::small_backbone::SmallBackbone;

/// A convolutional classifier: backbone, dropout and a linear head.
#[derive(Module, Debug)]
pub struct SmallClassifier {
    backbone: SmallBackbone,
    dropout: Dropout,
    head: Linear,
}

impl SmallClassifier {
    /// Creates a network of `classes` classes for images of `channels` channels; the first block has `width` channels.
    pub fn new(channels: usize, classes: usize, width: usize, dropout: f64, device: &Device) -> Self {
        let backbone = SmallBackbone::new(channels, width, device);
        let head = LinearConfig::new(backbone.features(), classes).init(device);
        Self { backbone, dropout: DropoutConfig::new(dropout).init(), head }
    }

    /// Computes logits `[batch, classes]` of images `[batch, channels, height, width]`.
    pub fn forward(&self, images: Tensor<4>) -> Tensor<2> {
        self.head.forward(self.dropout.forward(self.backbone.forward(images)))
    }
}
