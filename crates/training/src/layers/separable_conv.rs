//! Depthwise separable convolution.

use burn::config::Config;
use burn::module::Module;
use burn::tensor::{Device, Tensor};

use super::activation::Activation;
use super::conv_norm_act::{ConvNormAct, ConvNormActConfig};

/// Configuration of a [`SeparableConv`].
#[derive(Config, Debug)]
pub struct SeparableConvConfig {
    /// Number of input and output channels.
    pub channels: [usize; 2],
    /// Side of the depthwise kernel, odd.
    #[config(default = 3)]
    pub kernel: usize,
    /// Stride of the depthwise convolution.
    #[config(default = 1)]
    pub stride: usize,
    /// Dilation of the depthwise convolution.
    #[config(default = 1)]
    pub dilation: usize,
    /// Activation of each half.
    #[config(default = "Activation::Relu")]
    pub activation: Activation,
}

impl SeparableConvConfig {
    /// Initialises a block with random weights.
    pub fn init(&self, device: &Device) -> SeparableConv {
        let [from, to] = self.channels;
        let depthwise = ConvNormActConfig::new([from, from])
            .with_kernel(self.kernel)
            .with_stride(self.stride)
            .with_dilation(self.dilation)
            .with_groups(from)
            .with_activation(self.activation);
        let pointwise = ConvNormActConfig::new([from, to]).with_kernel(1).with_activation(self.activation);
        SeparableConv { depthwise: depthwise.init(device), pointwise: pointwise.init(device) }
    }
}

/// A depthwise convolution followed by a pointwise one (Howard et al., 2017).
#[derive(Module, Debug)]
pub struct SeparableConv {
    /// Depthwise convolution.
    pub depthwise: ConvNormAct,
    /// Pointwise convolution.
    pub pointwise: ConvNormAct,
}

impl SeparableConv {
    /// Returns `[batch, channels, ⌈height / stride⌉, ⌈width / stride⌉]` of `[batch, channels, height, width]`.
    pub fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        self.pointwise.forward(self.depthwise.forward(x))
    }
}
