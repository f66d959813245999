//! A small convolutional backbone: blocks of convolution, batch normalisation and ReLU, downsampled by strides, then global
//! average pooling.

use burn::module::Module;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, PaddingConfig2d};
use burn::tensor::{Device, Tensor};
use opendr_training::layers::Activation;
use opendr_training::operations::{batch_norm_act, conv2d};

/// A small convolutional backbone.
#[derive(Module, Debug)]
pub struct SmallBackbone {
    blocks: Vec<Block>,
    features: usize,
}

#[derive(Module, Debug)]
struct Block {
    conv: Conv2d,
    norm: BatchNorm,
}

/// Kernel and stride of each block; channels double with each stride.
const BLOCKS: [(usize, usize); 4] = [(5, 2), (3, 1), (3, 2), (3, 1)];

impl SmallBackbone {
    /// Creates a backbone for images of `channels` channels; the first block has `width` channels.
    pub fn new(channels: usize, width: usize, device: &Device) -> Self {
        let (mut inputs, mut outputs) = (channels, width);
        let blocks = BLOCKS.iter().enumerate().map(|(index, (kernel, stride))| {
            if index > 0 && *stride == 2 {
                outputs *= 2;
            }
            let block = Block::new(inputs, outputs, *kernel, *stride, device);
            inputs = outputs;
            block
        });
        let blocks = blocks.collect();
        Self { blocks, features: inputs }
    }

    /// Returns the number of features.
    pub fn features(&self) -> usize {
        self.features
    }

    /// Computes features `[batch, features]` of images `[batch, channels, height, width]`.
    pub fn forward(&self, images: Tensor<4>) -> Tensor<2> {
        let features = self.blocks.iter().fold(images, |features, block| block.forward(features));
        let [batch, channels, height, width] = features.dims();
        features.reshape([batch, channels, height * width]).mean_dim(2).squeeze_dim(2)
    }
}

impl Block {
    fn new(inputs: usize, outputs: usize, kernel: usize, stride: usize, device: &Device) -> Self {
        let padding = kernel / 2;
        let conv = Conv2dConfig::new([inputs, outputs], [kernel; 2])
            .with_stride([stride; 2])
            .with_padding(PaddingConfig2d::Explicit(padding, padding, padding, padding))
            .with_bias(false);
        Self { conv: conv.init(device), norm: BatchNormConfig::new(outputs).init(device) }
    }

    fn forward(&self, features: Tensor<4>) -> Tensor<4> {
        batch_norm_act(&self.norm, Activation::Relu, conv2d(&self.conv, features))
    }
}
