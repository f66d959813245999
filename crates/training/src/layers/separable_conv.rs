//! Depthwise separable convolution.

use burn::config::Config;
use burn::module::Module;
use burn::tensor::{Device, Tensor};

use super::activation::Activation;
use super::conv_norm_act::{ConvNormAct, ConvNormActConfig};

/// Sizes of a [`SeparableConv`].
#[derive(Config, Debug)]
pub struct SeparableConvConfig {
    /// Channels of input and output.
    pub channels: [usize; 2],
    /// Side of the kernel of the depthwise half, odd.
    #[config(default = 3)]
    pub kernel: usize,
    /// Step between its windows.
    #[config(default = 1)]
    pub stride: usize,
    /// Step between elements of its windows.
    #[config(default = 1)]
    pub dilation: usize,
    /// What follows each half.
    #[config(default = "Activation::Relu")]
    pub activation: Activation,
}

impl SeparableConvConfig {
    /// A block with random weights.
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

/// A convolution in each channel, then one over the channels (Howard et al., 2017).
#[derive(Module, Debug)]
pub struct SeparableConv {
    /// Over space, channel by channel.
    pub depthwise: ConvNormAct,
    /// Over channels, point by point.
    pub pointwise: ConvNormAct,
}

impl SeparableConv {
    /// `[batch, channels, height, width]` to `[batch, channels, ⌈height / stride⌉, ⌈width / stride⌉]`.
    pub fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        self.pointwise.forward(self.depthwise.forward(x))
    }
}
