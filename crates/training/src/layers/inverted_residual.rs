//! MobileNetV2's block.

use burn::config::Config;
use burn::module::Module;
use burn::tensor::{Device, Tensor};

use super::activation::Activation;
use super::conv_norm_act::{ConvNormAct, ConvNormActConfig};
use crate::operations::add_act;

/// Configuration of an [`InvertedResidual`].
#[derive(Config, Debug)]
pub struct InvertedResidualConfig {
    /// Number of input and output channels.
    pub channels: [usize; 2],
    /// Factor from the input channels to those of the depthwise convolution.
    #[config(default = 6)]
    pub expansion: usize,
    /// Side of the depthwise kernel, odd.
    #[config(default = 3)]
    pub kernel: usize,
    /// Stride of the depthwise convolution.
    #[config(default = 1)]
    pub stride: usize,
    /// Activation of the first two convolutions.
    #[config(default = "Activation::Relu6")]
    pub activation: Activation,
}

impl InvertedResidualConfig {
    /// Initialises a block with random weights.
    pub fn init(&self, device: &Device) -> InvertedResidual {
        let [from, to] = self.channels;
        let wide = from * self.expansion;
        let pointwise = |channels| ConvNormActConfig::new(channels).with_kernel(1);
        let expand = pointwise([from, wide]).with_activation(self.activation);
        let depthwise = ConvNormActConfig::new([wide, wide])
            .with_kernel(self.kernel)
            .with_stride(self.stride)
            .with_groups(wide)
            .with_activation(self.activation);
        InvertedResidual {
            expand: (wide != from).then(|| expand.init(device)),
            depthwise: depthwise.init(device),
            project: pointwise([wide, to]).with_activation(Activation::Identity).init(device),
            residual: self.stride == 1 && from == to,
        }
    }
}

/// Expansion, depthwise convolution and projection, with a residual connection where sizes allow (Sandler et al., 2018).
#[derive(Module, Debug)]
pub struct InvertedResidual {
    /// Expansion; `None` where the factor is 1.
    pub expand: Option<ConvNormAct>,
    /// Depthwise convolution.
    pub depthwise: ConvNormAct,
    /// Projection, without activation.
    pub project: ConvNormAct,
    residual: bool,
}

impl InvertedResidual {
    /// Returns `[batch, channels, ⌈height / stride⌉, ⌈width / stride⌉]` of `[batch, channels, height, width]`.
    pub fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        let wide = match &self.expand {
            Some(expand) => expand.forward(x.clone()),
            None => x.clone(),
        };
        let result = self.project.forward(self.depthwise.forward(wide));
        if self.residual { add_act(x, result, Activation::Identity) } else { result }
    }
}
