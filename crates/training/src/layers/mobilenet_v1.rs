//! MobileNetV1 as a backbone.

use burn::config::Config;
use burn::module::Module;
use burn::tensor::{Device, Tensor};

use super::activation::Activation;
use super::conv_norm_act::{ConvNormAct, ConvNormActConfig};
use super::separable_conv::{SeparableConv, SeparableConvConfig};

/// Channels at width 1, and stride, of the thirteen blocks (table 1 of the paper).
const BLOCKS: [(usize, usize); 13] = [
    (64, 1),
    (128, 2),
    (128, 1),
    (256, 2),
    (256, 1),
    (512, 2),
    (512, 1),
    (512, 1),
    (512, 1),
    (512, 1),
    (512, 1),
    (1024, 2),
    (1024, 1),
];

/// Configuration of a [`MobileNetV1`].
#[derive(Config, Debug)]
pub struct MobileNetV1Config {
    /// Factor on the number of channels; the product is rounded down, and at least 8.
    #[config(default = 1.0)]
    pub width: f64,
    /// Stride of the last block: 8, 16 or 32. Below 32, later blocks keep their size instead of halving it, as in PoseNet. With
    /// [`dilated`](Self::dilated) the receptive field stays the same.
    #[config(default = 32)]
    pub output_stride: usize,
    /// Whether blocks after an omitted stride are dilated instead.
    #[config(default = false)]
    pub dilated: bool,
    /// Strides whose features [`MobileNetV1::features`] returns, in increasing order.
    #[config(default = "vec![32]")]
    pub taps: Vec<usize>,
    /// Number of input channels.
    #[config(default = 3)]
    pub input_channels: usize,
    /// Number of blocks, from the first of the thirteen.
    #[config(default = 13)]
    pub blocks: usize,
}

impl MobileNetV1Config {
    /// Returns `channels` scaled by the width.
    pub fn scaled(&self, channels: usize) -> usize {
        ((channels as f64 * self.width) as usize).max(8)
    }

    /// Initialises a network with random weights.
    pub fn init(&self, device: &Device) -> MobileNetV1 {
        let mut channels = self.scaled(32);
        let stem = ConvNormActConfig::new([self.input_channels, channels])
            .with_stride(2)
            .with_activation(Activation::Relu6)
            .init(device);
        let (mut stride, mut dilation) = (2, 1);
        let mut strides = Vec::new();
        let mut blocks = Vec::new();
        for &(wide, step) in BLOCKS.iter().take(self.blocks) {
            let halves = stride * step <= self.output_stride;
            let to = self.scaled(wide);
            let block = SeparableConvConfig::new([channels, to])
                .with_stride(if halves { step } else { 1 })
                .with_dilation(dilation)
                .with_activation(Activation::Relu6);
            match halves {
                true => stride *= step,
                false if self.dilated => dilation *= step,
                false => {}
            }
            blocks.push(block.init(device));
            strides.push(stride);
            channels = to;
        }
        let last_of = |tap: &usize| strides.iter().rposition(|stride| stride == tap);
        MobileNetV1 { stem, blocks, taps: self.taps.iter().filter_map(last_of).collect() }
    }
}

/// MobileNetV1 (Howard et al., 2017) without its classifier, with ReLU6.
#[derive(Module, Debug)]
pub struct MobileNetV1 {
    /// First convolution, of stride 2; `Conv2d_0` in TensorFlow's weights.
    pub stem: ConvNormAct,
    /// Further blocks; `Conv2d_1_depthwise` and `Conv2d_1_pointwise` are the halves of the first one.
    pub blocks: Vec<SeparableConv>,
    /// Blocks whose output [`features`](Self::features) returns.
    taps: Vec<usize>,
}

impl MobileNetV1 {
    /// Returns the output of the last block.
    pub fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        self.blocks.iter().fold(self.stem.forward(x), |x, block| block.forward(x))
    }

    /// Returns the output of the last block of each stride in the configuration's taps; strides that no block has are skipped.
    pub fn features(&self, x: Tensor<4>) -> Vec<Tensor<4>> {
        let mut x = self.stem.forward(x);
        let mut features = Vec::with_capacity(self.taps.len());
        for (index, block) in self.blocks.iter().enumerate() {
            x = block.forward(x);
            if self.taps.contains(&index) {
                features.push(x.clone());
            }
        }
        features
    }

    /// Returns the number of channels of the outputs of [`features`](Self::features).
    pub fn feature_channels(&self) -> Vec<usize> {
        let channels = |&tap: &usize| Some(self.blocks.get(tap)?.pointwise.conv.weight.dims()[0]);
        self.taps.iter().filter_map(channels).collect()
    }
}
