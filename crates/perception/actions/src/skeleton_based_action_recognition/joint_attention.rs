//! Attention among the joints of a frame.

use burn::module::Module;
use burn::nn::{BatchNorm, BatchNormConfig, Dropout, DropoutConfig, Linear, LinearConfig};
use burn::tensor::activation::softmax;
use burn::tensor::{Device, Tensor};
use opendr_training::operations::batch_norm;

use super::sizes::{CHANNELS_PER_QUERY, HEADS};

/// Weights with which each joint receives the features of all joints of its frame, from the similarity of their features.
///
/// As no weight depends on another frame, the result of a frame is the same in a clip and in a stream (Hedegaard et al.,
/// Continual Spatio-Temporal Graph Convolutional Networks, 2022, restrict the attention of 2s-AGCN for the same reason).
#[derive(Module, Debug)]
pub(super) struct JointAttention {
    /// Normalisation of each feature of each joint, which distinguishes the joints.
    norm: Option<BatchNorm>,
    query: Linear,
    key: Linear,
    /// Features that are exchanged; without it, each head exchanges those of the input.
    value: Option<Linear>,
    dropout: Dropout,
    #[module(skip)]
    heads: usize,
}

impl JointAttention {
    /// Returns the adaptive edges of 2s-AGCN (Shi et al., Two-Stream Adaptive Graph Convolutional Networks, CVPR 2019), for the
    /// three adjacency matrices.
    pub fn adaptive([inputs, outputs]: [usize; 2], dropout: f64, device: &Device) -> Self {
        let depth = (outputs / CHANNELS_PER_QUERY).max(1);
        Self::new(3, [inputs, depth], None, dropout, device)
    }

    /// Returns the self-attention of the spatial transformer (Plizzari et al., Skeleton-based action recognition via spatial and
    /// temporal transformer networks, 2021).
    pub fn transformer([inputs, outputs]: [usize; 2], joints: usize, dropout: f64, device: &Device) -> Self {
        let depth = outputs / (CHANNELS_PER_QUERY * HEADS);
        let value = LinearConfig::new(inputs, outputs).init(device);
        let norm = BatchNormConfig::new(joints * inputs).init(device);
        Self { norm: Some(norm), ..Self::new(HEADS, [inputs, depth], Some(value), dropout, device) }
    }

    fn new(
        heads: usize,
        [inputs, depth]: [usize; 2],
        value: Option<Linear>,
        dropout: f64,
        device: &Device,
    ) -> Self {
        let linear = || LinearConfig::new(inputs, heads * depth).init(device);
        Self {
            norm: None,
            query: linear(),
            key: linear(),
            value,
            dropout: DropoutConfig::new(dropout).init(),
            heads,
        }
    }

    /// Returns the received features `[batch, heads * features, frames, joints]` of `[batch, channels, frames, joints]`. `edges`,
    /// `[heads, joints, joints]` from row to column, are added to the weights.
    pub fn forward(&self, signal: Tensor<4>, edges: Option<Tensor<3>>) -> Tensor<4> {
        let [batch, channels, frames, joints] = signal.dims();
        let count = batch * frames;
        let mut rows: Tensor<3> = signal.permute([0, 2, 3, 1]).reshape([count, joints, channels]);
        if let Some(norm) = &self.norm {
            let flat: Tensor<2> = rows.reshape([count, joints * channels]);
            rows = batch_norm(norm, flat).reshape([count, joints, channels]);
        }
        let query = self.split(self.query.forward(rows.clone()));
        let key = self.split(self.key.forward(rows.clone()));
        let [_, _, _, depth] = query.dims();
        let similarity = query.matmul(key.swap_dims(2, 3)) / (depth as f64).sqrt();
        let mut weights = self.dropout.forward(softmax(similarity, 3));
        if let Some(edges) = edges {
            weights = weights + edges.swap_dims(1, 2).unsqueeze::<4>();
        }
        let values = match &self.value {
            Some(value) => self.split(value.forward(rows)),
            None => rows.reshape([count, 1, joints, channels]),
        };
        let received = weights.matmul(values);
        let [.., features] = received.dims();
        let received = received.swap_dims(1, 2).reshape([batch, frames, joints, self.heads * features]);
        received.permute([0, 3, 1, 2])
    }

    /// Splits features `[frames, joints, heads * depth]` into `[frames, heads, joints, depth]`.
    fn split(&self, features: Tensor<3>) -> Tensor<4> {
        let [frames, joints, width] = features.dims();
        features.reshape([frames, joints, self.heads, width / self.heads]).swap_dims(1, 2)
    }
}
