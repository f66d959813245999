//! The network: MobileNetV1, an initial stage, and stages that refine the maps of the previous one.

use burn::config::Config;
use burn::module::{Module, Param};
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{Initializer, PaddingConfig2d};
use burn::tensor::{Device, Tensor};
use opendr_training::layers::{
    Activation, MobileNetV1, MobileNetV1Config, SeparableConv, SeparableConvConfig,
};
use opendr_training::operations::{add_act, conv2d, relu};

use super::STRIDE;
use crate::pose_estimation::part_affinity::{FIELDS, HEAT_MAPS};

/// Number of MobileNetV1's blocks in the paper: up to its `conv5_5`.
const BLOCKS: usize = 11;
/// Channels of the last of them at width 1.
const BLOCK_CHANNELS: usize = 512;
/// Number of blocks of a refinement stage.
const REFINEMENTS: usize = 5;
/// Hidden channels of the initial stage's heads, in multiples of a stage's channels.
const EXPANSION: usize = 4;

/// Sizes of a [`Network`].
#[derive(Config, Debug, PartialEq)]
pub struct NetworkConfig {
    /// Factor of the backbone's channels.
    #[config(default = 1.0)]
    pub width: f64,
    /// Number of blocks after the paper's, with as many channels as the last; PoseNet's backbone has 2.
    #[config(default = 0)]
    pub extra_blocks: usize,
    /// Channels of the stages.
    #[config(default = 128)]
    pub channels: usize,
    /// Whether convolutions of the stages are separable, with a seventh of the weights.
    #[config(default = false)]
    pub separable: bool,
    /// Number of stages after the initial one.
    #[config(default = 1)]
    pub refinement_stages: usize,
}

/// Maps of one stage: heatmaps `[batch, 19, height / 8, width / 8]` and fields `[batch, 38, height / 8, width / 8]`.
pub type Maps = [Tensor<4>; 2];

/// Lightweight OpenPose's network (Osokin, 2018, figure 3).
///
/// Unlike in the paper, all blocks of the backbone after the omitted stride are dilated, so that weights from a training
/// with that stride keep their receptive fields; the stages have no normalisation, so that small batches train and an
/// exported network can be reloaded without loss.
#[derive(Module, Debug)]
pub struct Network {
    /// Backbone: features of the image.
    pub backbone: Backbone,
    // In the order of their use, by which an exported network is reloaded.
    features: Features,
    initial_trunk: Vec<Conv>,
    initial: Heads,
    refinement: Vec<Refinement>,
}

impl NetworkConfig {
    /// Creates a network with random weights.
    pub fn init(&self, device: &Device) -> Network {
        let mobilenet = MobileNetV1Config::new()
            .with_width(self.width)
            .with_blocks(BLOCKS)
            .with_output_stride(STRIDE)
            .with_dilated(true);
        let wide = mobilenet.scaled(BLOCK_CHANNELS);
        let extra = || {
            let block = SeparableConvConfig::new([wide, wide]).with_dilation(2);
            block.with_activation(Activation::Relu6).init(device)
        };
        let backbone = Backbone {
            mobilenet: mobilenet.init(device),
            extra: (0..self.extra_blocks).map(|_| extra()).collect(),
        };
        let channels = self.channels;
        let conv = || self.conv(1, device);
        Network {
            backbone,
            features: Features {
                align: point([wide, channels], device),
                trunk: (0..3).map(|_| Conv::separable(channels, 1, device)).collect(),
                last: conv(),
            },
            initial_trunk: (0..3).map(|_| conv()).collect(),
            initial: Heads::new([channels, EXPANSION * channels], device),
            refinement: (0..self.refinement_stages).map(|_| self.refinement(device)).collect(),
        }
    }

    fn refinement(&self, device: &Device) -> Refinement {
        let block = |from: usize| RefinementBlock {
            align: point([from, self.channels], device),
            trunk: vec![self.conv(1, device), self.conv(2, device)],
        };
        let first = self.channels + HEAT_MAPS + FIELDS;
        Refinement {
            blocks: (0..REFINEMENTS).map(|at| block(if at == 0 { first } else { self.channels })).collect(),
            heads: Heads::new([self.channels; 2], device),
        }
    }

    fn conv(&self, dilation: usize, device: &Device) -> Conv {
        match self.separable {
            true => Conv::separable(self.channels, dilation, device),
            false => Conv::dense(self.channels, dilation, device),
        }
    }
}

impl Network {
    /// Computes the maps of every stage from images `[batch, 3, height, width]` of levels in -1..=1, whose sides are
    /// multiples of 8.
    pub fn forward(&self, pictures: Tensor<4>) -> Vec<Maps> {
        self.forward_from(self.backbone.forward(pictures))
    }

    /// Computes the maps of every stage from the backbone's features.
    pub fn forward_from(&self, backbone: Tensor<4>) -> Vec<Maps> {
        let features = self.features.forward(backbone);
        let first = self.initial_trunk.iter().fold(features.clone(), |x, conv| conv.forward(x));
        let mut stages = vec![self.initial.forward(first)];
        for refinement in &self.refinement {
            let before = stages.last().into_iter().flatten().cloned();
            let input = Tensor::cat([features.clone()].into_iter().chain(before).collect(), 1);
            stages.push(refinement.forward(input));
        }
        stages
    }

    /// Computes the maps of the last stage only.
    pub fn forward_last_stage(&self, pictures: Tensor<4>) -> Maps {
        let mut stages = self.forward(pictures);
        // There is at least an initial stage.
        stages.swap_remove(stages.len() - 1)
    }

    /// Returns the network with a frozen backbone.
    #[must_use]
    pub fn freeze_backbone(self) -> Self {
        Self { backbone: self.backbone.freeze(), ..self }
    }

    /// Returns the network with frozen batch normalisations in the backbone: those that are folded into an exported network
    /// have no statistics.
    #[must_use]
    pub fn freeze_norms(mut self) -> Self {
        let Backbone { mobilenet, extra } = &mut self.backbone;
        let stem = std::iter::once(&mut mobilenet.stem);
        let blocks = mobilenet.blocks.iter_mut().chain(extra);
        for layer in stem.chain(blocks.flat_map(|block| [&mut block.depthwise, &mut block.pointwise])) {
            layer.norm = layer.norm.clone().freeze();
        }
        self
    }
}

/// MobileNetV1 at stride 8.
#[derive(Module, Debug)]
pub struct Backbone {
    mobilenet: MobileNetV1,
    extra: Vec<SeparableConv>,
}

impl Backbone {
    /// Computes features of an eighth of the sides of `[batch, 3, height, width]`.
    pub fn forward(&self, pictures: Tensor<4>) -> Tensor<4> {
        self.extra.iter().fold(self.mobilenet.forward(pictures), |x, block| block.forward(x))
    }
}

/// Conversion from the backbone's channels to those of the stages (the paper's `Cpm`).
#[derive(Module, Debug)]
struct Features {
    align: Conv2d,
    trunk: Vec<Conv>,
    last: Conv,
}

impl Features {
    fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        let x = relu(conv2d(&self.align, x));
        let trunk = self.trunk.iter().fold(x.clone(), |x, conv| conv.forward(x));
        self.last.forward(add_act(x, trunk, Activation::Identity))
    }
}

/// The two heads of a stage: heatmaps and fields.
#[derive(Module, Debug)]
struct Heads {
    heat: [Conv2d; 2],
    fields: [Conv2d; 2],
}

impl Heads {
    /// Creates heads with `[input, hidden]` channels.
    fn new([input, hidden]: [usize; 2], device: &Device) -> Self {
        let head = |maps: usize| [point([input, hidden], device), maps_of([hidden, maps], device)];
        Self { heat: head(HEAT_MAPS), fields: head(FIELDS) }
    }

    fn forward(&self, x: Tensor<4>) -> Maps {
        let maps = |[hidden, last]: &[Conv2d; 2], x: Tensor<4>| conv2d(last, relu(conv2d(hidden, x)));
        [maps(&self.heat, x.clone()), maps(&self.fields, x)]
    }
}

/// A stage that refines the maps of the previous one.
#[derive(Module, Debug)]
struct Refinement {
    blocks: Vec<RefinementBlock>,
    heads: Heads,
}

impl Refinement {
    fn forward(&self, x: Tensor<4>) -> Maps {
        self.heads.forward(self.blocks.iter().fold(x, |x, block| block.forward(x)))
    }
}

/// A block with the receptive field of a 7x7 convolution.
#[derive(Module, Debug)]
struct RefinementBlock {
    align: Conv2d,
    trunk: Vec<Conv>,
}

impl RefinementBlock {
    fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        let x = relu(conv2d(&self.align, x));
        let trunk = self.trunk.iter().fold(x.clone(), |x, conv| conv.forward(x));
        add_act(trunk, x, Activation::Identity)
    }
}

/// A 3x3 convolution that keeps the number of channels, then ReLU; either dense or separable.
#[derive(Module, Debug)]
struct Conv {
    over_space: Conv2d,
    over_channels: Option<Conv2d>,
}

impl Conv {
    fn dense(channels: usize, dilation: usize, device: &Device) -> Self {
        Self { over_space: spatial(channels, dilation, 1, device), over_channels: None }
    }

    fn separable(channels: usize, dilation: usize, device: &Device) -> Self {
        let over_channels = Some(point([channels; 2], device));
        Self { over_space: spatial(channels, dilation, channels, device), over_channels }
    }

    fn forward(&self, x: Tensor<4>) -> Tensor<4> {
        let x = relu(conv2d(&self.over_space, x));
        match &self.over_channels {
            Some(conv) => relu(conv2d(conv, x)),
            None => x,
        }
    }
}

/// Initialisation after He et al. (2015), before a ReLU.
const BEFORE_RELU: Initializer =
    Initializer::KaimingNormal { gain: std::f64::consts::SQRT_2, fan_out_only: false };

fn spatial(channels: usize, dilation: usize, groups: usize, device: &Device) -> Conv2d {
    let pad = PaddingConfig2d::Explicit(dilation, dilation, dilation, dilation);
    let config = Conv2dConfig::new([channels; 2], [3; 2]).with_padding(pad).with_groups(groups);
    without_bias(config.with_dilation([dilation; 2]).with_initializer(BEFORE_RELU), device)
}

fn point(channels: [usize; 2], device: &Device) -> Conv2d {
    without_bias(Conv2dConfig::new(channels, [1; 2]).with_initializer(BEFORE_RELU), device)
}

/// Creates a last layer, whose outputs are initially near 0.
fn maps_of(channels: [usize; 2], device: &Device) -> Conv2d {
    let small = Initializer::Normal { mean: 0.0, std: 0.01 };
    without_bias(Conv2dConfig::new(channels, [1; 2]).with_initializer(small), device)
}

/// Creates a convolution with an initial bias of 0.
fn without_bias(config: Conv2dConfig, device: &Device) -> Conv2d {
    let mut conv = config.init(device);
    conv.bias = conv.bias.map(|bias| Param::from_tensor(bias.val().zeros_like()));
    conv
}
