//! ResNet-18.

use burn::config::Config;
use burn::module::Module;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::pool::{MaxPool2d, MaxPool2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, Initializer, Linear, LinearConfig, PaddingConfig2d};
use burn::tensor::module::adaptive_avg_pool2d;
use burn::tensor::{Device, Tensor};

use super::activation::Activation;
use crate::operations::{add_act, batch_norm, batch_norm_act, conv2d};

/// Configuration of a [`ResNet18`].
#[derive(Config, Debug)]
pub struct ResNet18Config {
    /// Number of classes.
    pub classes: usize,
    /// Number of input channels.
    #[config(default = 3)]
    pub input_channels: usize,
    /// Channels of the first stage; each further stage doubles them.
    #[config(default = 64)]
    pub width: usize,
    /// Whether images are small (32 x 32): the first convolution is 3 x 3 of stride 1, without pooling after it.
    #[config(default = false)]
    pub small: bool,
}

impl ResNet18Config {
    /// Initialises a network with random weights.
    pub fn init(&self, device: &Device) -> ResNet18 {
        let width = self.width;
        let (kernel, stride) = if self.small { (3, 1) } else { (7, 2) };
        let pool = MaxPool2dConfig::new([3, 3]).with_strides([2, 2]);
        let pool = pool.with_padding(PaddingConfig2d::Explicit(1, 1, 1, 1));
        let stage = |from: usize, to: usize, stride| {
            vec![BasicBlock::new([from, to], stride, device), BasicBlock::new([to, to], 1, device)]
        };
        ResNet18 {
            conv1: convolution([self.input_channels, width], kernel, stride, device),
            bn1: BatchNormConfig::new(width).init(device),
            pool: (!self.small).then(|| pool.init()),
            layer1: stage(width, width, 1),
            layer2: stage(width, 2 * width, 2),
            layer3: stage(2 * width, 4 * width, 2),
            layer4: stage(4 * width, 8 * width, 2),
            fc: LinearConfig::new(8 * width, self.classes).init(device),
        }
    }
}

fn convolution(channels: [usize; 2], kernel: usize, stride: usize, device: &Device) -> Conv2d {
    let pad = (kernel - 1) / 2;
    Conv2dConfig::new(channels, [kernel; 2])
        .with_stride([stride; 2])
        .with_padding(PaddingConfig2d::Explicit(pad, pad, pad, pad))
        .with_bias(false)
        .with_initializer(Initializer::KaimingNormal { gain: std::f64::consts::SQRT_2, fan_out_only: true })
        .init(device)
}

/// Two convolutions with a residual connection.
#[derive(Module, Debug)]
pub struct BasicBlock {
    /// First convolution, which may halve the size.
    pub conv1: Conv2d,
    /// Normalisation of the first convolution.
    pub bn1: BatchNorm,
    /// Second convolution.
    pub conv2: Conv2d,
    /// Normalisation of the second convolution.
    pub bn2: BatchNorm,
    /// Projection of the residual connection where sizes differ.
    pub downsample: Option<(Conv2d, BatchNorm)>,
}

impl BasicBlock {
    /// Creates a block with random weights.
    pub fn new(channels: [usize; 2], stride: usize, device: &Device) -> Self {
        let [from, to] = channels;
        let shortcut = || (convolution([from, to], 1, stride, device), BatchNormConfig::new(to).init(device));
        Self {
            conv1: convolution([from, to], 3, stride, device),
            bn1: BatchNormConfig::new(to).init(device),
            conv2: convolution([to, to], 3, 1, device),
            bn2: BatchNormConfig::new(to).init(device),
            downsample: (stride != 1 || from != to).then(shortcut),
        }
    }

    /// Returns `[batch, channels, ⌈height / stride⌉, ⌈width / stride⌉]` of `[batch, channels, height, width]`.
    pub fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        let result = batch_norm_act(&self.bn1, Activation::Relu, conv2d(&self.conv1, x.clone()));
        let result = batch_norm(&self.bn2, conv2d(&self.conv2, result));
        let shortcut = match &self.downsample {
            Some((conv, norm)) => batch_norm(norm, conv2d(conv, x)),
            None => x,
        };
        add_act(result, shortcut, Activation::Relu)
    }
}

/// ResNet-18 (He et al., 2016). Parameters have torchvision's names.
#[derive(Module, Debug)]
pub struct ResNet18 {
    /// First convolution.
    pub conv1: Conv2d,
    /// Normalisation of the first convolution.
    pub bn1: BatchNorm,
    pool: Option<MaxPool2d>,
    /// Stage of stride 4 (1 for small images).
    pub layer1: Vec<BasicBlock>,
    /// Stage of stride 8 (2).
    pub layer2: Vec<BasicBlock>,
    /// Stage of stride 16 (4).
    pub layer3: Vec<BasicBlock>,
    /// Stage of stride 32 (8).
    pub layer4: Vec<BasicBlock>,
    /// The classifier.
    pub fc: Linear,
}

impl ResNet18 {
    /// Returns logits `[batch, classes]` of images `[batch, channels, height, width]`.
    pub fn forward(&self, x: Tensor<4>) -> Tensor<2> {
        let [_, _, _, features] = self.features(x);
        self.fc.forward(adaptive_avg_pool2d(features, [1, 1]).flatten(1, 3))
    }

    /// Returns the outputs of the four stages.
    pub fn features(&self, x: Tensor<4>) -> [Tensor<4>; 4] {
        let x = batch_norm_act(&self.bn1, Activation::Relu, conv2d(&self.conv1, x));
        let x = match &self.pool {
            Some(pool) => pool.forward(x),
            None => x,
        };
        let stage = |x, blocks: &[BasicBlock]| blocks.iter().fold(x, |x, block| block.forward(x));
        let first = stage(x, &self.layer1);
        let second = stage(first.clone(), &self.layer2);
        let third = stage(second.clone(), &self.layer3);
        let fourth = stage(third.clone(), &self.layer4);
        [first, second, third, fourth]
    }
}
