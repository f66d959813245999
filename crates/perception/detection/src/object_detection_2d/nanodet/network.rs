//! NanoDet-g as a Burn module: a cross-stage partial backbone, a bidirectional feature pyramid, one head per level.
//!
//! Batch normalisations are folded into the convolutions, as in the zoo's file, so a further training has no statistics
//! that a small batch could spoil.

use burn::module::{Module, Param};
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{Initializer, PaddingConfig2d};
use burn::tensor::activation::sigmoid;
use burn::tensor::module::{avg_pool2d, interpolate, max_pool2d};
use burn::tensor::ops::{AvgPoolOptions, InterpolateMode, InterpolateOptions, MaxPoolOptions};
use burn::tensor::{Device, Tensor};
use opendr_training::layers::Activation;
use opendr_training::operations::conv2d;

use super::{BINS, STRIDES};
use crate::object_detection_2d::cells::cells;

/// Channels of the pyramid.
const WIDTH: usize = 128;
/// Number of logits of the distances to a box's four sides.
pub const DISTANCES: usize = 4 * BINS;
/// Score of an untrained head (Lin et al., Focal loss, section 4.1).
const PRIOR: f32 = 0.01;

/// The network. Fields are in the order of the zoo's graph.
#[derive(Module, Debug)]
pub struct NanodetNetwork {
    stem: Conv2d,
    first: CspBlock,
    levels: Vec<Level>,
    heads: Vec<Head>,
}

/// A block that halves the resolution, and its lateral connection to the pyramid.
#[derive(Module, Debug)]
struct Level {
    block: CspBlock,
    lateral: Conv2d,
}

/// A block in which half of the channels bypass the residual blocks (CSPNet, Wang et al., 2020).
#[derive(Module, Debug)]
struct CspBlock {
    enter: Conv2d,
    residuals: Vec<Residual>,
    leave: Conv2d,
}

/// Two convolutions in sequence, whose outputs are concatenated.
#[derive(Module, Debug)]
struct Residual {
    first: Conv2d,
    second: Conv2d,
}

#[derive(Module, Debug)]
struct Head {
    conv: Conv2d,
    /// Scores of the classes, then distances.
    output: Conv2d,
}

impl NanodetNetwork {
    /// Creates a network for `classes` classes with random weights.
    pub fn new(classes: usize, device: &Device) -> Self {
        let level = |(channels, blocks): (usize, usize)| Level {
            block: CspBlock::new(channels, 2, blocks, device),
            lateral: conv(2 * channels, WIDTH, 1, 1, device),
        };
        let head = |_: &usize| Head {
            conv: conv(WIDTH, WIDTH, 3, 1, device),
            output: conv(WIDTH, classes + DISTANCES, 1, 1, device),
        };
        let network = Self {
            stem: conv(3, 32, 3, 2, device),
            first: CspBlock::new(32, 1, 1, device),
            levels: [(64, 2), (128, 2), (256, 3)].into_iter().map(level).collect(),
            heads: STRIDES.iter().map(head).collect(),
        };
        network.with_classes(classes)
    }

    /// Returns the number of classes.
    pub fn classes(&self) -> usize {
        self.heads.first().map_or(0, |head| head.output.weight.dims()[0].saturating_sub(DISTANCES))
    }

    /// Returns the network with untrained score outputs for `classes` classes; the weights for boxes stay.
    #[must_use]
    pub fn with_classes(mut self, classes: usize) -> Self {
        for Head { output, .. } in &mut self.heads {
            let device = output.weight.device();
            let rows = output.weight.dims()[0];
            let weights = Tensor::random(
                [classes, WIDTH, 1, 1],
                burn::tensor::Distribution::Normal(0.0, 0.01),
                &device,
            );
            let biases = Tensor::full([classes], (PRIOR / (1.0 - PRIOR)).ln(), &device);
            let distances = output.weight.val().narrow(0, rows - DISTANCES, DISTANCES);
            output.weight = Param::from_tensor(Tensor::cat(vec![weights, distances], 0).detach());
            output.bias = output.bias.take().map(|bias| {
                let distances = bias.val().narrow(0, rows - DISTANCES, DISTANCES);
                Param::from_tensor(Tensor::cat(vec![biases, distances], 0).detach())
            });
        }
        self
    }

    /// Returns the network with a frozen backbone.
    #[must_use]
    pub fn freeze_backbone(mut self) -> Self {
        self.stem = self.stem.freeze();
        self.first = self.first.freeze();
        for level in &mut self.levels {
            level.block = level.block.clone().freeze();
        }
        self
    }

    /// Returns the network with a frozen backbone and a frozen pyramid; only the heads train.
    #[must_use]
    pub fn freeze_features(mut self) -> Self {
        self = self.freeze_backbone();
        self.levels = self.levels.into_iter().map(Module::freeze).collect();
        self
    }

    /// Returns the logits of each level, fine to coarse: `[images, classes + 4 * BINS, height / stride, width / stride]`,
    /// of images `[images, 3, height, width]` with sides that are multiples of the coarsest stride.
    pub fn forward(&self, pictures: Tensor<4>) -> Vec<Tensor<4>> {
        let pool = MaxPoolOptions::new([3, 3]).with_stride([2, 2]).with_padding([1, 1]);
        let mut features = max_pool2d(activated(&self.stem, pictures), pool);
        features = self.first.forward(features);
        let mut pyramid = Vec::new();
        for level in &self.levels {
            features = level.block.forward(features);
            pyramid.push(level.lateral.forward(features.clone()));
        }
        for fine in (1..pyramid.len()).rev() {
            pyramid[fine - 1] = pyramid[fine - 1].clone() + doubled(pyramid[fine].clone());
        }
        for coarse in 1..pyramid.len() {
            pyramid[coarse] = pyramid[coarse].clone() + halved(pyramid[coarse - 1].clone());
        }
        self.heads.iter().zip(pyramid).map(|(head, features)| head.forward(features)).collect()
    }

    /// Returns the outputs of the exported network: scores `[images, cells, classes]` of each level, then logits of
    /// distances `[images, cells, 4 * BINS]` of each.
    pub fn infer(&self, pictures: Tensor<4>) -> Vec<Tensor<3>> {
        let classes = self.classes();
        let rows: Vec<Tensor<3>> = self.forward(pictures).into_iter().map(cells).collect();
        let scores = rows.iter().map(|rows| sigmoid(rows.clone().narrow(2, 0, classes)));
        let distances = rows.iter().map(|rows| rows.clone().narrow(2, classes, DISTANCES));
        scores.chain(distances).collect()
    }
}

impl CspBlock {
    fn new(channels: usize, stride: usize, blocks: usize, device: &Device) -> Self {
        let residual = |_| Residual {
            first: conv(channels, channels / 2, 3, 1, device),
            second: conv(channels / 2, channels / 2, 3, 1, device),
        };
        Self {
            enter: conv(channels, channels, 3, stride, device),
            residuals: (0..blocks).map(residual).collect(),
            leave: conv(channels, channels, 3, 1, device),
        }
    }

    /// Returns twice as many channels as the input.
    fn forward(&self, features: Tensor<4>) -> Tensor<4> {
        let entered = activated(&self.enter, features);
        let residual = |features, Residual { first, second }: &Residual| {
            let lower = activated(first, features);
            Tensor::cat(vec![activated(second, lower.clone()), lower], 1)
        };
        let refined = self.residuals.iter().fold(entered.clone(), residual);
        Tensor::cat(vec![activated(&self.leave, refined), entered], 1)
    }
}

impl Head {
    fn forward(&self, features: Tensor<4>) -> Tensor<4> {
        conv2d(&self.output, activated(&self.conv, features))
    }
}

fn conv(inputs: usize, outputs: usize, side: usize, stride: usize, device: &Device) -> Conv2d {
    let padding = side / 2;
    Conv2dConfig::new([inputs, outputs], [side, side])
        .with_stride([stride, stride])
        .with_padding(PaddingConfig2d::Explicit(padding, padding, padding, padding))
        .with_initializer(Initializer::KaimingNormal { gain: std::f64::consts::SQRT_2, fan_out_only: false })
        .init(device)
}

fn activated(conv: &Conv2d, features: Tensor<4>) -> Tensor<4> {
    Activation::LeakyRelu.apply(conv2d(conv, features))
}

fn doubled(features: Tensor<4>) -> Tensor<4> {
    let [_, _, height, width] = features.dims();
    let options = InterpolateOptions::new(InterpolateMode::Bilinear).with_align_corners(false);
    interpolate(features, options.with_output_size([2 * height, 2 * width]))
}

/// Resizes linearly to half the size, which is the mean of each four values.
fn halved(features: Tensor<4>) -> Tensor<4> {
    avg_pool2d(features, AvgPoolOptions::new([2, 2]))
}
