//! A small classifier of pictures.

use burn::module::Module;
use burn::nn::{Dropout, DropoutConfig, Linear, LinearConfig};
use burn::tensor::{Device, Tensor};

use crate::small_backbone::SmallBackbone;

/// A convolutional classifier.
#[derive(Module, Debug)]
pub struct SmallClassifier {
    backbone: SmallBackbone,
    dropout: Dropout,
    head: Linear,
}

impl SmallClassifier {
    /// Makes a network for pictures of so many channels that tells `classes` apart, `width` channels in its first block.
    pub fn new(channels: usize, classes: usize, width: usize, dropout: f64, device: &Device) -> Self {
        let backbone = SmallBackbone::new(channels, width, device);
        let head = LinearConfig::new(backbone.features(), classes).init(device);
        Self { backbone, dropout: DropoutConfig::new(dropout).init(), head }
    }

    /// Computes, of pictures `[batch, channels, height, width]`, scores `[batch, classes]`.
    pub fn forward(&self, images: Tensor<4>) -> Tensor<2> {
        self.head.forward(self.dropout.forward(self.backbone.forward(images)))
    }
}
