//! The trained network: four convolutions.

use burn::module::Module;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig};
use burn::tensor::{Device, Tensor};
use opendr_training::layers::Activation;
use opendr_training::operations::{batch_norm_act, conv2d};

use super::PatchArchitecture;

/// Three convolutions of stride 2 and one with the size of the remaining patch. None is padded, so the output for a patch is
/// the same alone and within an image.
#[derive(Module, Debug)]
pub struct PatchNetwork {
    first: Block,
    second: Block,
    third: Block,
    answer: Conv2d,
}

#[derive(Module, Debug)]
struct Block {
    conv: Conv2d,
    norm: BatchNorm,
}

impl PatchNetwork {
    /// Creates a network of an architecture.
    pub fn new(architecture: PatchArchitecture, device: &Device) -> Self {
        let width = match architecture {
            PatchArchitecture::Vgg720p => 16,
            PatchArchitecture::Vgg1080p => 8,
        };
        let halved = |side: usize, kernel: usize| (side - kernel) / 2 + 1;
        let left = halved(halved(halved(architecture.side(), 5), 3), 3);
        Self {
            first: Block::new(3, width, 5, device),
            second: Block::new(width, 2 * width, 3, device),
            third: Block::new(2 * width, 2 * width, 3, device),
            answer: Conv2dConfig::new([2 * width, 2], [left; 2]).init(device),
        }
    }

    /// Returns logits `[batch, 2, rows, columns]` of `[batch, 3, height, width]`, one row and column for a patch.
    pub fn forward(&self, pictures: Tensor<4>) -> Tensor<4> {
        let features = self.third.forward(self.second.forward(self.first.forward(pictures)));
        conv2d(&self.answer, features)
    }
}

impl Block {
    fn new(inputs: usize, outputs: usize, kernel: usize, device: &Device) -> Self {
        let conv = Conv2dConfig::new([inputs, outputs], [kernel; 2]).with_stride([2; 2]).with_bias(false);
        Self { conv: conv.init(device), norm: BatchNormConfig::new(outputs).init(device) }
    }

    fn forward(&self, features: Tensor<4>) -> Tensor<4> {
        batch_norm_act(&self.norm, Activation::Relu, conv2d(&self.conv, features))
    }
}
