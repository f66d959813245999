//! Convolution, batch normalisation, activation.

use burn::config::Config;
use burn::module::Module;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, Initializer, PaddingConfig2d};
use burn::tensor::{Device, Tensor};

use super::activation::Activation;

/// Sizes of a [`ConvNormAct`].
#[derive(Config, Debug)]
pub struct ConvNormActConfig {
    /// Channels of input and output.
    pub channels: [usize; 2],
    /// Side of the kernel, odd.
    #[config(default = 3)]
    pub kernel: usize,
    /// Step between windows.
    #[config(default = 1)]
    pub stride: usize,
    /// Step between elements of a window.
    #[config(default = 1)]
    pub dilation: usize,
    /// Groups of channels that do not mix.
    #[config(default = 1)]
    pub groups: usize,
    /// What follows the normalisation.
    #[config(default = "Activation::Relu")]
    pub activation: Activation,
}

impl ConvNormActConfig {
    /// A block with as much padding as keeps the size at stride 1, and weights drawn after He et al. (2015).
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

/// Convolution without bias, batch normalisation, activation; one convolution once it is exported.
#[derive(Module, Debug)]
pub struct ConvNormAct {
    /// The convolution.
    pub conv: Conv2d,
    /// The normalisation of its result.
    pub norm: BatchNorm,
    /// What follows.
    #[module(skip)]
    pub activation: Activation,
}

impl ConvNormAct {
    /// `[batch, channels, height, width]` to `[batch, channels, ⌈height / stride⌉, ⌈width / stride⌉]`.
    pub fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        self.activation.apply(self.norm.forward(self.conv.forward(x)))
    }
}
