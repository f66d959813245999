//! Networks of Burn's layers.

use burn::module::{Module, Param};
use burn::nn::attention::{MhaInput, MultiHeadAttention, MultiHeadAttentionConfig};
use burn::nn::conv::{Conv1d, Conv1dConfig, ConvTranspose2d, ConvTranspose2dConfig};
use burn::nn::{
    BatchNorm, BatchNormConfig, Dropout, DropoutConfig, GroupNorm, GroupNormConfig, InstanceNorm,
    InstanceNormConfig, LayerNorm, LayerNormConfig, Linear, LinearConfig, PRelu, PReluConfig,
    PaddingConfig1d,
};
use burn::tensor::activation::{gelu, hard_sigmoid, hard_swish, relu, softmax};
use burn::tensor::module::{adaptive_avg_pool2d, interpolate};
use burn::tensor::ops::{InterpolateMode, InterpolateOptions};
use burn::tensor::{Device, Distribution, Tensor};
use opendr_training::layers::{Activation, ConvNormAct, ConvNormActConfig};

use super::case::{Case, case};

pub fn all() -> Vec<Case> {
    vec![
        case("u_net", [1, 2, 16, 24], &["mask"], UNet::new, UNet::forward),
        case("separable_1d", [1, 8, 30], &["logits"], Separable1d::new, Separable1d::forward),
        case("perceptron", [1, 10], &["logits", "probabilities"], Perceptron::new, Perceptron::forward),
        case("squeeze_excite", [1, 6, 12, 12], &["features"], SqueezeExcite::new, SqueezeExcite::forward),
        case("transformer", [1, 7, 8], &["tokens"], Transformer::new, Transformer::forward),
        case("other_norms", [1, 6, 5, 4], &["features"], Norms::new, Norms::forward),
    ]
}

/// Down by convolution, up by transposed convolution and by bilinear resizing, with a skip connection.
#[derive(Module, Debug)]
struct UNet {
    down: [ConvNormAct; 2],
    up: ConvTranspose2d,
    norm: BatchNorm,
    out: ConvNormAct,
}

impl UNet {
    fn new(device: &Device) -> Self {
        let block = |channels, stride| ConvNormActConfig::new(channels).with_stride(stride).init(device);
        let up = ConvTranspose2dConfig::new([12, 6], [3, 3]).with_stride([2, 2]).with_groups(2);
        Self {
            down: [block([2, 6], 1), block([6, 12], 2)],
            up: up.with_padding([1, 1]).with_padding_out([1, 1]).init(device),
            norm: BatchNormConfig::new(6).init(device),
            out: ConvNormActConfig::new([18, 1])
                .with_kernel(1)
                .with_activation(Activation::Sigmoid)
                .init(device),
        }
    }

    fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        let [_, _, height, width] = x.dims();
        let skip = self.down[0].forward(x);
        let deep = self.down[1].forward(skip.clone());
        let learned = relu(self.norm.forward(self.up.forward(deep.clone())));
        let options = InterpolateOptions::new(InterpolateMode::Bilinear).with_align_corners(false);
        let smooth = interpolate(deep, options.with_output_size([height, width]));
        self.out.forward(Tensor::cat(vec![learned, smooth.narrow(1, 0, 6), skip], 1))
    }
}

/// Separable 1D convolutions as in MatchboxNet.
#[derive(Module, Debug)]
struct Separable1d {
    depthwise: Conv1d,
    pointwise: Conv1d,
    norm: BatchNorm,
    dropout: Dropout,
    classifier: Linear,
}

impl Separable1d {
    fn new(device: &Device) -> Self {
        let depthwise = Conv1dConfig::new(8, 8, 4).with_groups(8).with_dilation(2).with_bias(false);
        Self {
            depthwise: depthwise.with_padding(PaddingConfig1d::Explicit(4, 2)).init(device),
            pointwise: Conv1dConfig::new(8, 12, 1).init(device),
            norm: BatchNormConfig::new(12).init(device),
            dropout: DropoutConfig::new(0.5).init(),
            classifier: LinearConfig::new(12, 5).init(device),
        }
    }

    fn forward(&self, x: Tensor<3>) -> Tensor<2> {
        let x = relu(self.norm.forward(self.pointwise.forward(self.depthwise.forward(x))));
        self.classifier.forward(self.dropout.forward(x).mean_dim(2).squeeze_dim::<2>(2))
    }
}

#[derive(Module, Debug)]
struct Perceptron {
    first: Linear,
    norm: LayerNorm,
    slope: PRelu,
    second: Linear,
}

impl Perceptron {
    fn new(device: &Device) -> Self {
        Self {
            first: LinearConfig::new(10, 16).init(device),
            norm: LayerNormConfig::new(16).init(device),
            slope: PReluConfig::new().with_num_parameters(16).init(device),
            second: LinearConfig::new(16, 4).with_bias(false).init(device),
        }
    }

    fn forward(&self, x: Tensor<2>) -> (Tensor<2>, Tensor<2>) {
        let x = self.slope.forward(gelu(self.norm.forward(self.first.forward(x))));
        let logits = self.second.forward(x);
        (logits.clone(), softmax(logits, 1))
    }
}

/// A block of MobileNetV3.
#[derive(Module, Debug)]
struct SqueezeExcite {
    expand: ConvNormAct,
    squeeze: ConvNormAct,
    excite: ConvNormAct,
    project: ConvNormAct,
}

impl SqueezeExcite {
    fn new(device: &Device) -> Self {
        let block = |channels, activation| {
            ConvNormActConfig::new(channels).with_kernel(1).with_activation(activation).init(device)
        };
        Self {
            expand: block([6, 16], Activation::HardSwish),
            squeeze: block([16, 4], Activation::Relu),
            excite: block([4, 16], Activation::Identity),
            project: block([16, 6], Activation::Identity),
        }
    }

    fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        let wide = self.expand.forward(x.clone());
        let squeezed = self.squeeze.forward(adaptive_avg_pool2d(wide.clone(), [1, 1]));
        let gate = hard_sigmoid(self.excite.forward(squeezed), 1.0 / 6.0, 0.5);
        hard_swish(x + self.project.forward(wide * gate))
    }
}

/// Attention with learned positions, which are expanded over the batch.
#[derive(Module, Debug)]
struct Transformer {
    positions: Param<Tensor<3>>,
    attention: MultiHeadAttention,
    norm: LayerNorm,
}

impl Transformer {
    fn new(device: &Device) -> Self {
        let positions = Tensor::random([1, 7, 8], Distribution::Normal(0.0, 1.0), device);
        Self {
            positions: Param::from_tensor(positions),
            attention: MultiHeadAttentionConfig::new(8, 2).init(device),
            norm: LayerNormConfig::new(8).init(device),
        }
    }

    fn forward(&self, x: Tensor<3>) -> Tensor<3> {
        let [batch, _, _] = x.dims();
        let x = x + self.positions.val().repeat_dim(0, batch);
        self.norm.forward(x.clone() + self.attention.forward(MhaInput::self_attn(x)).context)
    }
}

#[derive(Module, Debug)]
struct Norms {
    group: GroupNorm,
    instance: InstanceNorm,
}

impl Norms {
    fn new(device: &Device) -> Self {
        Self {
            group: GroupNormConfig::new(3, 6).init(device),
            instance: InstanceNormConfig::new(6).init(device),
        }
    }

    fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        self.instance.forward(self.group.forward(x))
    }
}
