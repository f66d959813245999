//! The network for training: MobileNetV1 with MobileFaceNet's head, and the centres of ArcFace's classes.

use burn::module::{Module, Param};
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, Initializer, Linear, LinearConfig};
use burn::tensor::{Device, Tensor};
use opendr_training::layers::{MobileNetV1, MobileNetV1Config};
use opendr_training::operations::{batch_norm, conv2d};

use super::SIDE;

/// Pixels of the image per cell of the last features.
const STRIDE: usize = 16;
/// Channels of the last block at width 1.
const CHANNELS: usize = 1024;

/// A network from an aligned face to its embedding.
#[derive(Module, Debug)]
pub struct Network {
    backbone: MobileNetV1,
    /// Weighted sum over the cells per channel, instead of their mean (MobileFaceNets, Chen et al., 2018).
    spatial: Conv2d,
    head: Linear,
    norm: BatchNorm,
    /// Centres `[classes, dimension]`; not part of the exported network.
    centres: Param<Tensor<2>>,
}

impl Network {
    /// Creates a network with random weights for faces of `classes` persons.
    pub fn new(classes: usize, dimension: usize, width: f64, device: &Device) -> Self {
        let mobilenet = MobileNetV1Config::new().with_width(width).with_output_stride(STRIDE);
        let channels = mobilenet.scaled(CHANNELS);
        let spatial = Conv2dConfig::new([channels, channels], [SIDE / STRIDE; 2]).with_groups(channels);
        Self {
            backbone: mobilenet.init(device),
            spatial: spatial.with_bias(false).init(device),
            head: LinearConfig::new(channels, dimension).with_bias(false).init(device),
            norm: BatchNormConfig::new(dimension).init(device),
            centres: Initializer::Normal { mean: 0.0, std: 1.0 }.init([classes, dimension], device),
        }
    }

    /// Computes embeddings `[batch, dimension]` of faces `[batch, 3, 112, 112]` with levels 0..=255.
    pub fn embed(&self, faces: Tensor<4>) -> Tensor<2> {
        let features = conv2d(&self.spatial, self.backbone.forward(faces * (1.0 / 127.5) - 1.0));
        let [batch, channels, ..] = features.dims();
        batch_norm(&self.norm, self.head.forward(features.reshape([batch, channels])))
    }

    /// Returns the cosines `[batch, classes]` between embeddings and the centres of the classes.
    pub fn cosines(&self, embeddings: Tensor<2>) -> Tensor<2> {
        unit(embeddings).matmul(unit(self.centres.val()).transpose())
    }
}

/// Scales rows to length 1.
fn unit(rows: Tensor<2>) -> Tensor<2> {
    let length = rows.clone().powf_scalar(2.0).sum_dim(1).add_scalar(1e-12).sqrt();
    rows / length
}
