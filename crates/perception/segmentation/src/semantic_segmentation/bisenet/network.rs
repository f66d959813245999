//! The trained network.

use burn::module::Module;
use burn::nn::PaddingConfig2d;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::tensor::activation::sigmoid;
use burn::tensor::{Device, Tensor};
use opendr_training::layers::{BasicBlock, ConvNormAct, ConvNormActConfig, bilinear};
use opendr_training::operations::{conv2d, relu};

/// Network from images to class scores.
#[derive(Module, Debug)]
pub struct BisenetNetwork {
    spatial: Vec<ConvNormAct>,
    stem: ConvNormAct,
    context: Vec<BasicBlock>,
    attention: Vec<Conv2d>,
    tail: Conv2d,
    reduce: Vec<ConvNormAct>,
    fuse: ConvNormAct,
    gate: Vec<Conv2d>,
    head: ConvNormAct,
    scores: Conv2d,
}

impl BisenetNetwork {
    /// Creates a network with random weights for `classes` classes, with `width` channels in its first layers and a spatial
    /// path that ends at 1/8 of the input's resolution, or at 1/4 where `is_fine`.
    pub fn new(classes: usize, width: usize, is_fine: bool, device: &Device) -> Self {
        let block = |from: usize, to: usize, kernel: usize, stride: usize| {
            ConvNormActConfig::new([from, to]).with_kernel(kernel).with_stride(stride).init(device)
        };
        let wide = 4 * width;
        let (last_stride, merged) = if is_fine { (1, 2 * width) } else { (2, wide) };
        Self {
            spatial: vec![
                block(3, width, 5, 2),
                block(width, width, 3, 2),
                block(width, 2 * width, 3, last_stride),
            ],
            stem: block(3, width, 5, 2),
            context: (0..4)
                .map(|stage: u32| {
                    let channels = |stage: u32| width << stage.saturating_sub(1).min(3);
                    BasicBlock::new([channels(stage), channels(stage + 1)], 2, device)
                })
                .collect(),
            attention: vec![point([wide, wide], device), point([2 * wide, 2 * wide], device)],
            tail: point([2 * wide, 2 * wide], device),
            reduce: vec![block(wide, 2 * width, 3, 1), block(2 * wide, 2 * width, 3, 1)],
            fuse: block(4 * width, merged, 1, 1),
            gate: vec![point([merged, width], device), point([width, merged], device)],
            head: block(merged, merged, 3, 1),
            scores: point([merged, classes], device),
        }
    }

    /// Returns scores `[batch, classes, height, width]` of `[batch, 3, height, width]`, sides multiples of 32.
    pub fn forward(&self, pictures: Tensor<4>) -> Tensor<4> {
        let [_, _, height, width] = pictures.dims();
        let spatial = self.spatial.iter().fold(pictures.clone(), |x, block| block.forward(x));
        let size = side(&spatial);
        let mut x = self.stem.forward(pictures);
        let mut stages = Vec::new();
        for block in &self.context {
            x = block.forward(x);
            stages.push(x.clone());
        }
        // The last two stages, at 1/16 and 1/32 of the resolution, each weighted by channel attention.
        let deep = stages.split_off(2);
        let whole = conv2d(&self.tail, mean(x));
        let weighed = deep.into_iter().zip(&self.attention).enumerate().map(|(stage, (x, attention))| {
            let x = x.clone() * sigmoid(attention.forward(mean(x)));
            if stage == 1 { x + whole.clone() } else { x }
        });
        let context = weighed.zip(&self.reduce).map(|(x, reduce)| bilinear(reduce.forward(x), size));
        let context = context.reduce(|one, other| one + other);
        let parts = [Some(spatial), context].into_iter().flatten().collect();
        let fused = self.fuse.forward(Tensor::cat(parts, 1));
        let gate = self.gate.iter().fold(mean(fused.clone()), |x, layer| layer.forward(relu(x)));
        let fused = fused.clone() + fused * sigmoid(gate);
        bilinear(conv2d(&self.scores, self.head.forward(fused)), [height, width])
    }
}

fn point([from, to]: [usize; 2], device: &Device) -> Conv2d {
    Conv2dConfig::new([from, to], [1, 1]).with_padding(PaddingConfig2d::Valid).init(device)
}

fn side(x: &Tensor<4>) -> [usize; 2] {
    let [_, _, height, width] = x.dims();
    [height, width]
}

/// Returns the mean over the image, `[batch, channels, 1, 1]`.
fn mean(x: Tensor<4>) -> Tensor<4> {
    x.mean_dim(3).mean_dim(2)
}
