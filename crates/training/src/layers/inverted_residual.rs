//! MobileNetV2's block.

use burn::config::Config;
use burn::module::Module;
use burn::tensor::{Device, Tensor};

use super::activation::Activation;
use super::conv_norm_act::{ConvNormAct, ConvNormActConfig};

/// Sizes of an [`InvertedResidual`].
#[derive(Config, Debug)]
pub struct InvertedResidualConfig {
    /// Channels of input and output.
    pub channels: [usize; 2],
    /// Factor from the channels of the input to those of the depthwise convolution.
    #[config(default = 6)]
    pub expansion: usize,
    /// Side of the depthwise kernel, odd.
    #[config(default = 3)]
    pub kernel: usize,
    /// Step between its windows.
    #[config(default = 1)]
    pub stride: usize,
    /// What follows the first two convolutions.
    #[config(default = "Activation::Relu6")]
    pub activation: Activation,
}

impl InvertedResidualConfig {
    /// A block with random weights.
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

/// Narrow to wide, a depthwise convolution, back to narrow, around a shortcut where sizes allow (Sandler et al., 2018).
#[derive(Module, Debug)]
pub struct InvertedResidual {
    /// To more channels; none where the expansion is 1.
    pub expand: Option<ConvNormAct>,
    /// Over space, channel by channel.
    pub depthwise: ConvNormAct,
    /// To fewer channels, without activation.
    pub project: ConvNormAct,
    residual: bool,
}

impl InvertedResidual {
    /// `[batch, channels, height, width]` to `[batch, channels, ⌈height / stride⌉, ⌈width / stride⌉]`.
    pub fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        let wide = match &self.expand {
            Some(expand) => expand.forward(x.clone()),
            None => x.clone(),
        };
        let result = self.project.forward(self.depthwise.forward(wide));
        if self.residual { x + result } else { result }
    }
}
