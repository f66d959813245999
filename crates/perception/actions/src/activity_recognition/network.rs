//! The trained network, for clips and for single frames of a stream.

use burn::module::Module;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{
    BatchNorm, BatchNormConfig, Dropout, DropoutConfig, Initializer, Linear, LinearConfig, PaddingConfig2d,
};
use burn::tensor::activation::sigmoid;
use burn::tensor::{Device, Tensor};
use opendr_training::layers::Activation;
use opendr_training::operations::{add_act, batch_norm, batch_norm_act, conv2d, relu};

use super::Sizes;
use super::time::Time;

/// X3D (Feichtenhofer, X3D: Expanding Architectures for Efficient Video Recognition, CVPR 2020): frames
/// `[batch * time, 3, side, side]`, the frames of each clip in sequence, to logits `[batch, classes]`.
///
/// Two differences from the paper: convolutions through time are causal, and squeeze and excitation covers one frame. The first
/// frame of a clip is repeated for the time before it. The network therefore runs frame by frame with the same result.
#[derive(Module, Debug)]
pub(super) struct ActivityNetwork {
    stem: Conv2d,
    stem_time: CausalDepthwise,
    stem_norm: BatchNorm,
    blocks: Vec<Block>,
    last: Conv2d,
    last_norm: BatchNorm,
    hidden: Linear,
    dropout: Dropout,
    classifier: Linear,
}

/// A bottleneck with a depthwise convolution over space and time and a residual connection.
#[derive(Module, Debug)]
struct Block {
    expand: Conv2d,
    expand_norm: BatchNorm,
    depthwise: CausalDepthwise,
    depthwise_norm: BatchNorm,
    excitation: Option<Excitation>,
    project: Conv2d,
    project_norm: BatchNorm,
    /// Projection of the residual connection, where stride or channels change.
    past: Option<Conv2d>,
    past_norm: Option<BatchNorm>,
}

/// A depthwise convolution over space and time, computed as one 2D convolution per time step whose results are added. It equals
/// a 3D convolution and runs on runtimes that only have 2D convolutions.
#[derive(Module, Debug)]
struct CausalDepthwise {
    now: Conv2d,
    /// Convolutions of the previous frame, of the one before it, and so on.
    earlier: Vec<Conv2d>,
}

/// Channel weights from the mean over a frame (Hu et al., Squeeze-and-Excitation Networks, CVPR 2018).
#[derive(Module, Debug)]
struct Excitation {
    squeeze: Linear,
    excite: Linear,
}

/// Channels inside a block, as a multiple of its output channels.
const BOTTLENECK: f64 = 2.25;
/// Kernel size in time of the stem and of the blocks.
const STEM_TAPS: usize = 5;
const TAPS: usize = 3;

impl ActivityNetwork {
    /// Returns a network with initial weights.
    pub fn new(sizes: &Sizes, classes: usize, dropout: f64, device: &Device) -> Self {
        let stem = sizes.channels(24);
        let mut inputs = stem;
        let mut blocks = Vec::new();
        for (stage, outputs) in [24, 48, 96, 192].map(|width| sizes.channels(width)).into_iter().enumerate() {
            for index in 0..sizes.blocks(stage) {
                let stride = if index == 0 { 2 } else { 1 };
                blocks.push(Block::new([inputs, outputs], stride, index.is_multiple_of(2), device));
                inputs = outputs;
            }
        }
        let last = (inputs as f64 * BOTTLENECK) as usize;
        let hidden = sizes.channels(2048);
        Self {
            stem: convolution([3, stem], 3, 2, 1, device),
            stem_time: CausalDepthwise::new(stem, 1, 1, STEM_TAPS, device),
            stem_norm: BatchNormConfig::new(stem).init(device),
            blocks,
            last: convolution([inputs, last], 1, 1, 1, device),
            last_norm: BatchNormConfig::new(last).init(device),
            hidden: LinearConfig::new(last, hidden).with_bias(false).init(device),
            dropout: DropoutConfig::new(dropout).init(),
            classifier: LinearConfig::new(hidden, classes).init(device),
        }
    }

    /// Returns logits `[batch, classes]`.
    pub fn forward(&self, frames: Tensor<4>, time: &mut Time) -> Tensor<2> {
        let signal = self.stem_time.forward(conv2d(&self.stem, frames), time);
        let signal = batch_norm_act(&self.stem_norm, Activation::Relu, signal);
        let signal = self.blocks.iter().fold(signal, |signal, block| block.forward(signal, time));
        let signal = batch_norm_act(&self.last_norm, Activation::Relu, conv2d(&self.last, signal));
        let pooled = time.mean(mean_of_frames(signal));
        let hidden = relu(self.hidden.forward(pooled));
        self.classifier.forward(self.dropout.forward(hidden))
    }
}

impl Block {
    fn new([inputs, outputs]: [usize; 2], stride: usize, excites: bool, device: &Device) -> Self {
        let middle = (outputs as f64 * BOTTLENECK) as usize;
        let norm = |channels: usize| BatchNormConfig::new(channels).init(device);
        let changes = stride != 1 || inputs != outputs;
        Self {
            expand: convolution([inputs, middle], 1, 1, 1, device),
            expand_norm: norm(middle),
            depthwise: CausalDepthwise::new(middle, 3, stride, TAPS, device),
            depthwise_norm: norm(middle),
            excitation: excites.then(|| Excitation::new(middle, device)),
            project: convolution([middle, outputs], 1, 1, 1, device),
            project_norm: norm(outputs),
            past: changes.then(|| convolution([inputs, outputs], 1, stride, 1, device)),
            past_norm: changes.then(|| norm(outputs)),
        }
    }

    fn forward(&self, signal: Tensor<4>, time: &mut Time) -> Tensor<4> {
        let past = match (&self.past, &self.past_norm) {
            (Some(past), Some(norm)) => batch_norm(norm, conv2d(past, signal.clone())),
            _ => signal.clone(),
        };
        let inner = batch_norm_act(&self.expand_norm, Activation::Relu, conv2d(&self.expand, signal));
        let inner = batch_norm(&self.depthwise_norm, self.depthwise.forward(inner, time));
        let inner = match &self.excitation {
            Some(excitation) => excitation.forward(inner),
            None => inner,
        };
        let result = batch_norm(&self.project_norm, conv2d(&self.project, Activation::Silu.apply(inner)));
        add_act(past, result, Activation::Relu)
    }
}

impl CausalDepthwise {
    fn new(channels: usize, kernel: usize, stride: usize, taps: usize, device: &Device) -> Self {
        let tap = |_| convolution([channels; 2], kernel, stride, channels, device);
        Self { now: tap(0), earlier: (1..taps).map(tap).collect() }
    }

    fn forward(&self, signal: Tensor<4>, time: &mut Time) -> Tensor<4> {
        let earlier = self.earlier.iter().map(|tap| conv2d(tap, signal.clone())).collect();
        time.sum(conv2d(&self.now, signal), earlier)
    }
}

impl Excitation {
    fn new(channels: usize, device: &Device) -> Self {
        let inner = (channels / 16).next_multiple_of(8);
        Self {
            squeeze: LinearConfig::new(channels, inner).init(device),
            excite: LinearConfig::new(inner, channels).init(device),
        }
    }

    fn forward(&self, signal: Tensor<4>) -> Tensor<4> {
        let [frames, channels, ..] = signal.dims();
        let weights = relu(self.squeeze.forward(mean_of_frames(signal.clone())));
        let weights = sigmoid(self.excite.forward(weights));
        signal * weights.reshape([frames, channels, 1, 1])
    }
}

/// Returns the mean over each frame, `[frames, channels]`.
fn mean_of_frames(signal: Tensor<4>) -> Tensor<2> {
    let [frames, channels, height, width] = signal.dims();
    signal.reshape([frames, channels, height * width]).mean_dim(2).reshape([frames, channels])
}

fn convolution(channels: [usize; 2], kernel: usize, stride: usize, groups: usize, device: &Device) -> Conv2d {
    let pad = kernel / 2;
    Conv2dConfig::new(channels, [kernel; 2])
        .with_stride([stride; 2])
        .with_groups(groups)
        .with_padding(PaddingConfig2d::Explicit(pad, pad, pad, pad))
        .with_bias(false)
        .with_initializer(Initializer::KaimingNormal {
            gain: std::f64::consts::SQRT_2,
            fan_out_only: groups == 1,
        })
        .init(device)
}
