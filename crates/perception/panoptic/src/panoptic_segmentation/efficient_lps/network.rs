//! The trained network.

use burn::module::Module;
use burn::nn::PaddingConfig2d;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::tensor::{Device, Tensor};
use opendr_training::layers::{BasicBlock, ConvNormAct, ConvNormActConfig, bilinear};
use opendr_training::operations::conv2d;

use super::CHANNELS;

/// Network from range images to class scores: three stages down and three up with skip connections (O. Ronneberger et al.,
/// "U-Net", MICCAI 2015).
#[derive(Module, Debug)]
pub struct RangeNetwork {
    stem: ConvNormAct,
    down: Vec<BasicBlock>,
    up: Vec<ConvNormAct>,
    scores: Conv2d,
}

/// Number of stages; the sides of a range image are multiples of two to this power.
pub(super) const STAGES: usize = 3;

impl RangeNetwork {
    /// Creates a network with random weights for `classes` classes, with `width` channels in its first layer.
    pub fn new(classes: usize, width: usize, device: &Device) -> Self {
        let channels = |stage: usize| width << stage;
        let beside = |stage: usize| [channels(stage) + channels(stage + 1), channels(stage)];
        Self {
            stem: ConvNormActConfig::new([CHANNELS, width]).init(device),
            down: (0..STAGES)
                .map(|stage| BasicBlock::new([channels(stage), channels(stage + 1)], 2, device))
                .collect(),
            up: (0..STAGES).rev().map(|stage| ConvNormActConfig::new(beside(stage)).init(device)).collect(),
            scores: Conv2dConfig::new([width, classes], [1, 1])
                .with_padding(PaddingConfig2d::Valid)
                .init(device),
        }
    }

    /// Returns scores `[batch, classes, rows, columns]` of `[batch, 5, rows, columns]`, sides multiples of 8.
    pub fn forward(&self, scans: Tensor<4>) -> Tensor<4> {
        let mut x = self.stem.forward(scans);
        let mut finer = Vec::with_capacity(STAGES);
        for block in &self.down {
            finer.push(x.clone());
            x = block.forward(x);
        }
        for (block, beside) in self.up.iter().zip(finer.into_iter().rev()) {
            let [_, _, rows, columns] = beside.dims();
            x = block.forward(Tensor::cat(vec![beside, bilinear(x, [rows, columns])], 1));
        }
        conv2d(&self.scores, x)
    }
}
