//! The trained network, for clips and for single frames of a stream.

use burn::module::Module;
use burn::nn::{BatchNorm, BatchNormConfig, Dropout, DropoutConfig, Linear, LinearConfig};
use burn::tensor::{Device, Tensor};
use opendr_engine::Result;
use opendr_training::operations::batch_norm;

use super::block::Block;
use super::frame_selection::FrameSelection;
use super::sizes::{Architecture, BLOCKS_BEFORE_SELECTION, NetworkSizes};
use super::stream_state::StreamState;

/// Spatio-temporal convolutions over skeletons: features `[batch, features, frames, joints]` to logits `[batch, classes]`.
///
/// Different from the papers of the architectures, no block pads or strides in time, so [`ActionNetwork::step`] computes frame by
/// frame what [`ActionNetwork::forward`] computes for the clip that ends with the frame (Hedegaard et al., Continual
/// Spatio-Temporal Graph Convolutional Networks, 2022, omit padding for the same reason).
#[derive(Module, Debug)]
pub(super) struct ActionNetwork {
    scale: BatchNorm,
    blocks: Vec<Block>,
    selection: Option<FrameSelection>,
    dropout: Dropout,
    classifier: Linear,
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
            let block = Block::new(sizes, index, [inputs, *channels], dropout, device);
            inputs = *channels;
            block
        });
        let blocks = blocks.collect();
        let selection = match sizes.architecture {
            Architecture::TaGcn { subframes } => Some(FrameSelection::new(sizes.frames, subframes, device)),
            _ => None,
        };
        Ok(Self {
            scale: BatchNormConfig::new(sizes.features()).init(device),
            blocks,
            selection,
            dropout: DropoutConfig::new(dropout).init(),
            classifier: LinearConfig::new(inputs, classes).init(device),
        })
    }

    /// Returns logits `[batch, classes]` of clips `[batch, features, frames, joints]`.
    pub fn forward(&self, clips: Tensor<4>) -> Tensor<2> {
        let mut signal = batch_norm(&self.scale, clips);
        for (index, block) in self.blocks.iter().enumerate() {
            match &self.selection {
                Some(selection) if index == BLOCKS_BEFORE_SELECTION => signal = selection.forward(signal),
                _ => {}
            }
            signal = block.forward(signal);
        }
        let [batch, channels, frames, _] = signal.dims();
        let pooled: Tensor<3> = signal.mean_dim(3).reshape([batch, channels, frames]);
        let pooled = pooled.mean_dim(2).reshape([batch, channels]);
        self.classifier.forward(self.dropout.forward(pooled))
    }

    /// Returns logits `[1, classes]` of the clip that ends with `frame` `[1, features, 1, joints]`, and the next state. `state`
    /// is `[1, NetworkSizes::state]`. The network must select no frames.
    pub fn step(&self, frame: Tensor<4>, state: Tensor<2>) -> (Tensor<2>, Tensor<2>) {
        let mut state = StreamState::new(state);
        let signal = batch_norm(&self.scale, frame);
        let signal = self.blocks.iter().fold(signal, |signal, block| block.step(signal, &mut state));
        let [_, channels, _, _] = signal.dims();
        let before = state.rest() / channels;
        let window = state.window(signal.mean_dim(3), before);
        let pooled = window.mean_dim(2).reshape([1, channels]);
        (self.classifier.forward(pooled), state.next())
    }
}
