//! Convolution, batch normalisation, activation.

use burn::config::Config;
use burn::module::Module;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, Initializer, PaddingConfig2d};
use burn::tensor::{Device, Tensor};

use super::activation::Activation;
use crate::operations::{batch_norm_act, conv2d};

/// Configuration of a [`ConvNormAct`].
#[derive(Config, Debug)]
pub struct ConvNormActConfig {
    /// Number of input and output channels.
    pub channels: [usize; 2],
    /// Side of the kernel, odd.
    #[config(default = 3)]
    pub kernel: usize,
    /// Stride.
    #[config(default = 1)]
    pub stride: usize,
    /// Dilation.
    #[config(default = 1)]
    pub dilation: usize,
    /// Number of groups.
    #[config(default = 1)]
    pub groups: usize,
    /// Activation after the normalisation.
    #[config(default = "Activation::Relu")]
    pub activation: Activation,
}

impl ConvNormActConfig {
    /// Initialises a block with padding that keeps the size at stride 1, and weights after He et al. (2015).
    pub fn init(&self, device: &Device) -> ConvNormAct {
        let pad = self.dilation * (self.kernel - 1) / 2;
        let conv = Conv2dConfig::new(self.channels, [self.kernel; 2])
            .with_stride([self.stride; 2])
            .with_dilation([self.dilation; 2])
            .with_groups(self.groups)
            .with_padding(PaddingConfig2d::Explicit(pad, pad, pad, pad))
            .with_bias(false)
            .with_initializer(Initializer::KaimingNormal {
                gain: std::f64::consts::SQRT_2,
                fan_out_only: true,
            })
            .init(device);
        ConvNormAct {
            conv,
            norm: BatchNormConfig::new(self.channels[1]).init(device),
            activation: self.activation,
        }
    }
}

/// Convolution without bias, batch normalisation, activation; exported as one convolution.
#[derive(Module, Debug)]
pub struct ConvNormAct {
    /// The convolution.
    pub conv: Conv2d,
    /// The normalisation.
    pub norm: BatchNorm,
    /// The activation.
    #[module(skip)]
    pub activation: Activation,
}

impl ConvNormAct {
    /// Returns `[batch, channels, ⌈height / stride⌉, ⌈width / stride⌉]` of `[batch, channels, height, width]`.
    pub fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        batch_norm_act(&self.norm, self.activation, conv2d(&self.conv, x))
    }
}
