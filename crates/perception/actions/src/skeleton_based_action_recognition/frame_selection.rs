//! Selection of the frames of a clip by attention.

use burn::module::Module;
use burn::nn::{Linear, LinearConfig};
use burn::tensor::activation::{relu, sigmoid};
use burn::tensor::{Device, Int, Tensor};

/// Temporal attention module (Heidari and Iosifidis, Temporal Attention-Augmented Graph Convolutional Network for Efficient
/// Skeleton-Based Human Action Recognition, ICPR 2020): weights the frames of a clip and keeps those with the highest weights, in
/// their order.
#[derive(Module, Debug)]
pub(super) struct FrameSelection {
    attention: Linear,
    #[module(skip)]
    kept: usize,
}

impl FrameSelection {
    /// Returns a module that keeps `kept` of `frames` frames, with initial weights.
    pub fn new(frames: usize, kept: usize, device: &Device) -> Self {
        Self { attention: LinearConfig::new(frames, frames).init(device), kept }
    }

    /// Returns the weighted frames `[batch, channels, kept, joints]` of clips `[batch, channels, frames, joints]`.
    pub fn forward(&self, signal: Tensor<4>) -> Tensor<4> {
        let [batch, channels, frames, joints] = signal.dims();
        let means: Tensor<2> = signal.clone().mean_dim(3).mean_dim(1).reshape([batch, frames]);
        let weights = sigmoid(self.attention.forward(means));
        let weighted = relu(signal * weights.clone().reshape([batch, 1, frames, 1]));
        if self.kept == frames {
            return weighted;
        }
        // Sorted as floats: backends and runtimes sort integers less often.
        let kept = weights.argtopk(self.kept, 1).float().sort(1).int();
        let kept: Tensor<4, Int> = kept.reshape([batch, 1, self.kept, 1]);
        weighted.gather(2, kept.expand([batch, channels, self.kept, joints]))
    }
}
