//! The trained network, for clips and for single frames of a stream.

use burn::module::{Module, Param};
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, Dropout, DropoutConfig, Initializer, Linear, LinearConfig};
use burn::tensor::activation::relu;
use burn::tensor::{Device, Tensor, TensorData};
use opendr_engine::Result;

use super::sizes::NetworkSizes;

/// Spatio-temporal graph convolutions (Yan et al., AAAI 2018): features `[batch, features, frames, joints]` to logits
/// `[batch, classes]`.
///
/// Different from the paper, no block pads or strides in time, so [`ActionNetwork::step`] computes frame by frame what
/// [`ActionNetwork::forward`] computes for the clip that ends with the frame (Hedegaard et al., Continual Spatio-Temporal Graph
/// Convolutional Networks, 2022, omit padding for the same reason).
#[derive(Module, Debug)]
pub(super) struct ActionNetwork {
    scale: BatchNorm,
    blocks: Vec<Block>,
    dropout: Dropout,
    classifier: Linear,
}

/// A graph convolution in each frame, a convolution through time at each joint, and a residual connection.
#[derive(Module, Debug)]
struct Block {
    /// Learnt weight of each edge.
    importance: Param<Tensor<3>>,
    mixing: Conv2d,
    mixing_norm: BatchNorm,
    temporal: Conv2d,
    temporal_norm: BatchNorm,
    dropout: Dropout,
    past: Past,
    #[module(skip)]
    adjacency: Vec<f32>,
}

/// Residual connection of a block.
#[derive(Module, Debug)]
struct Past {
    /// Projection, where the number of channels changes.
    convolution: Option<Conv2d>,
    norm: Option<BatchNorm>,
    /// Whether the block has a residual connection; the first has none.
    #[module(skip)]
    is_there: bool,
}

impl ActionNetwork {
    /// Returns a network with initial weights.
    ///
    /// # Errors
    /// As [`NetworkSizes::pooled_frames`].
    pub fn new(sizes: &NetworkSizes, classes: usize, dropout: f64, device: &Device) -> Result<Self> {
        sizes.pooled_frames()?;
        let mut inputs = sizes.features();
        let blocks = sizes.channels.iter().enumerate().map(|(index, channels)| {
            let block = Block::new(sizes, [inputs, *channels], index > 0, dropout, device);
            inputs = *channels;
            block
        });
        let blocks = blocks.collect();
        Ok(Self {
            scale: BatchNormConfig::new(sizes.features()).init(device),
            blocks,
            dropout: DropoutConfig::new(dropout).init(),
            classifier: LinearConfig::new(inputs, classes).init(device),
        })
    }

    /// Returns logits `[batch, classes]` of clips `[batch, features, frames, joints]`.
    pub fn forward(&self, clips: Tensor<4>) -> Tensor<2> {
        let signal = self.scale.forward(clips);
        let signal = self.blocks.iter().fold(signal, |signal, block| block.forward(signal));
        let [batch, channels, frames, _] = signal.dims();
        let pooled: Tensor<3> = signal.mean_dim(3).reshape([batch, channels, frames]);
        let pooled = pooled.mean_dim(2).reshape([batch, channels]);
        self.classifier.forward(self.dropout.forward(pooled))
    }

    /// Returns logits `[1, classes]` of the clip that ends with `frame` `[1, features, 1, joints]`, and the next state. `state`
    /// is `[1, NetworkSizes::state]`.
    pub fn step(&self, frame: Tensor<4>, state: Tensor<2>) -> (Tensor<2>, Tensor<2>) {
        let [_, numbers] = state.dims();
        let mut rest = Rest { state, at: 0 };
        let mut kept = Vec::new();
        let signal = self.scale.forward(frame);
        let signal =
            self.blocks.iter().fold(signal, |signal, block| block.step(signal, &mut rest, &mut kept));
        let [_, channels, _, _] = signal.dims();
        let now: Tensor<3> = signal.mean_dim(3).reshape([1, channels, 1]);
        let before = (numbers - rest.at) / channels;
        let window = match before {
            0 => now,
            before => Tensor::cat(vec![rest.take(channels * before).reshape([1, channels, before]), now], 2),
        };
        if before > 0 {
            kept.push(
                window.clone().slice([0..1, 0..channels, 1..before + 1]).reshape([1, channels * before]),
            );
        }
        let pooled = window.mean_dim(2).reshape([1, channels]);
        (self.classifier.forward(pooled), Tensor::cat(kept, 1))
    }
}

/// Part of a state that is not yet consumed.
struct Rest {
    state: Tensor<2>,
    at: usize,
}

impl Rest {
    fn take(&mut self, count: usize) -> Tensor<2> {
        let start = self.at;
        self.at += count;
        self.state.clone().slice([0..1, start..self.at])
    }
}

impl Block {
    fn new(
        sizes: &NetworkSizes,
        [inputs, outputs]: [usize; 2],
        past: bool,
        dropout: f64,
        device: &Device,
    ) -> Self {
        let (joints, kernel) = (sizes.graph.joints(), sizes.kernel);
        let convolution = |inputs: usize, kernel: [usize; 2]| {
            let config = Conv2dConfig::new([inputs, outputs], kernel).with_bias(false);
            let drawn = Initializer::KaimingNormal { gain: std::f64::consts::SQRT_2, fan_out_only: true };
            config.with_initializer(drawn).init(device)
        };
        let norm = || BatchNormConfig::new(outputs).init(device);
        let other = past && inputs != outputs;
        Self {
            importance: Initializer::Ones.init([3, joints, joints], device),
            mixing: convolution(3 * inputs, [1, 1]),
            mixing_norm: norm(),
            temporal: convolution(outputs, [kernel, 1]),
            temporal_norm: norm(),
            dropout: DropoutConfig::new(dropout).init(),
            past: Past {
                convolution: other.then(|| convolution(inputs, [1, 1])),
                norm: other.then(norm),
                is_there: past,
            },
            adjacency: sizes.graph.adjacency(),
        }
    }

    /// Returns `[batch, channels, frames, joints]` with `kernel - 1` frames fewer.
    fn forward(&self, signal: Tensor<4>) -> Tensor<4> {
        let reach = self.reach();
        let [batch, channels, frames, joints] = signal.dims();
        let mixed = self.mix(signal.clone());
        // Without padding, the output belongs to the frame in the middle of the kernel.
        let past = signal.slice([0..batch, 0..channels, reach..frames - reach, 0..joints]);
        self.join(mixed, past)
    }

    /// Returns the output `[1, channels, 1, joints]` for the frame `reach` frames ago.
    fn step(&self, signal: Tensor<4>, rest: &mut Rest, kept: &mut Vec<Tensor<2>>) -> Tensor<4> {
        let mixed = window(self.mix(signal.clone()), 2 * self.reach(), rest, kept);
        let past = match self.past.is_there {
            true => {
                let [_, channels, _, joints] = signal.dims();
                window(signal, self.reach(), rest, kept).slice([0..1, 0..channels, 0..1, 0..joints])
            }
            false => signal,
        };
        self.join(mixed, past)
    }

    /// Number of frames before and after the centre of the kernel.
    fn reach(&self) -> usize {
        self.temporal.weight.dims()[2] / 2
    }

    /// The graph convolution: features of the joint itself, of nearer and of farther joints, mixed by a 1x1 convolution.
    fn mix(&self, signal: Tensor<4>) -> Tensor<4> {
        let [batch, channels, frames, joints] = signal.dims();
        let data = TensorData::new(self.adjacency.clone(), [3, joints, joints]);
        let weights = Tensor::<3>::from_data(data, &signal.device()) * self.importance.val();
        let rows = signal.reshape([batch * channels * frames, joints]);
        let parts = (0..3).map(|part| {
            let weights =
                weights.clone().slice([part..part + 1, 0..joints, 0..joints]).reshape([joints, joints]);
            rows.clone().matmul(weights).reshape([batch, channels, frames, joints])
        });
        let mixed = self.mixing.forward(Tensor::cat(parts.collect(), 1));
        relu(self.mixing_norm.forward(mixed))
    }

    fn join(&self, mixed: Tensor<4>, past: Tensor<4>) -> Tensor<4> {
        let moved = self.dropout.forward(self.temporal_norm.forward(self.temporal.forward(mixed)));
        match (&self.past.convolution, &self.past.norm) {
            _ if !self.past.is_there => relu(moved),
            (Some(convolution), Some(norm)) => relu(moved + norm.forward(convolution.forward(past))),
            _ => relu(moved + past),
        }
    }
}

/// Returns the last `before` frames and `frame`; pushes the frames that the next step needs into `kept`.
fn window(frame: Tensor<4>, before: usize, rest: &mut Rest, kept: &mut Vec<Tensor<2>>) -> Tensor<4> {
    if before == 0 {
        return frame;
    }
    let [_, channels, _, joints] = frame.dims();
    let past = rest.take(channels * before * joints).reshape([1, channels, before, joints]);
    let window = Tensor::cat(vec![past, frame], 2);
    let next = window.clone().slice([0..1, 0..channels, 1..before + 1, 0..joints]);
    kept.push(next.reshape([1, channels * before * joints]));
    window
}
