//! The trained network.

use burn::module::Module;
use burn::nn::conv::{Conv1d, Conv1dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, Dropout, DropoutConfig, Linear, LinearConfig, PaddingConfig1d};
use burn::tensor::{Device, Tensor};
use opendr_perception_common::small_backbone::SmallBackbone;
use opendr_training::layers::Activation;
use opendr_training::operations::{batch_norm_act, conv1d};

use super::AudiovisualFusion;
use super::cross_attention::CrossAttention;
use super::front_end::Sizes;

/// Network from cepstra and faces to logits.
#[derive(Module, Debug)]
pub(super) struct AudiovisualNetwork {
    faces: SmallBackbone,
    /// Two halves of each branch.
    audio: Vec<TimeBlocks>,
    video: Vec<TimeBlocks>,
    audio_of_video: CrossAttention,
    video_of_audio: CrossAttention,
    dropout: Dropout,
    classifier: Linear,
    #[module(skip)]
    fusion: AudiovisualFusion,
    frames: usize,
}

/// Channels after the halves of each branch.
const AUDIO: [usize; 2] = [128, 128];
const VIDEO: [usize; 2] = [64, 128];

impl AudiovisualNetwork {
    /// Returns a network with initial weights; `width` is the number of channels of the first block for faces.
    pub fn new(
        sizes: &Sizes,
        fusion: AudiovisualFusion,
        classes: usize,
        (width, dropout): (usize, f64),
        device: &Device,
    ) -> Self {
        let faces = SmallBackbone::new(3, width, device);
        let late = usize::from(fusion == AudiovisualFusion::LateTransformer);
        let [sound, face] = [AUDIO[late], VIDEO[late]];
        Self {
            audio: vec![
                TimeBlocks::new([Sizes::COEFFICIENTS, AUDIO[0]], 2, device),
                TimeBlocks::new(AUDIO, 2, device),
            ],
            video: vec![
                TimeBlocks::new([faces.features(), VIDEO[0]], 1, device),
                TimeBlocks::new(VIDEO, 1, device),
            ],
            faces,
            audio_of_video: CrossAttention::new([sound, face], device),
            video_of_audio: CrossAttention::new([face, sound], device),
            dropout: DropoutConfig::new(dropout).init(),
            classifier: LinearConfig::new(AUDIO[1] + VIDEO[1], classes).init(device),
            fusion,
            frames: sizes.frames,
        }
    }

    /// Returns logits `[batch, classes]` of cepstra `[batch, coefficients, time steps]` and faces
    /// `[batch * frames, 3, side, side]`.
    pub fn forward(&self, cepstra: Tensor<3>, faces: Tensor<4>) -> Tensor<2> {
        let [batch, ..] = cepstra.dims();
        let faces = self.faces.forward(faces);
        let [_, features] = faces.dims();
        let faces = faces.reshape([batch, self.frames, features]).swap_dims(1, 2);
        let (audio, video) = (half(&self.audio, 0, cepstra), half(&self.video, 0, faces));
        let (audio, video) = match self.fusion {
            AudiovisualFusion::IntermediateAttention => (
                audio.clone() * self.video_of_audio.importance(video.clone(), audio.clone()),
                video.clone() * self.audio_of_video.importance(audio, video),
            ),
            AudiovisualFusion::IntermediateTransformer => (
                audio.clone() + self.audio_of_video.attended(audio.clone(), video.clone()),
                video.clone() + self.video_of_audio.attended(video, audio),
            ),
            AudiovisualFusion::LateTransformer => (audio, video),
        };
        let (audio, video) = (half(&self.audio, 1, audio), half(&self.video, 1, video));
        let (audio, video) = match self.fusion {
            AudiovisualFusion::LateTransformer => (
                self.audio_of_video.attended(audio.clone(), video.clone()),
                self.video_of_audio.attended(video, audio),
            ),
            _ => (audio, video),
        };
        let mean = |series: Tensor<3>| {
            let [batch, channels, _] = series.dims();
            series.mean_dim(2).reshape([batch, channels])
        };
        let both = Tensor::cat(vec![mean(audio), mean(video)], 1);
        self.classifier.forward(self.dropout.forward(both))
    }
}

fn half(branch: &[TimeBlocks], at: usize, series: Tensor<3>) -> Tensor<3> {
    branch.iter().skip(at).take(1).fold(series, |series, blocks| blocks.forward(series))
}

/// Two temporal convolutions, the second with a stride; `[batch, inputs, steps]` to `[batch, outputs, fewer steps]`.
#[derive(Module, Debug)]
struct TimeBlocks {
    convolutions: Vec<Conv1d>,
    norms: Vec<BatchNorm>,
}

impl TimeBlocks {
    fn new([inputs, outputs]: [usize; 2], stride: usize, device: &Device) -> Self {
        let convolution = |inputs: usize, stride: usize| {
            let config = Conv1dConfig::new(inputs, outputs, 3).with_stride(stride).with_bias(false);
            config.with_padding(PaddingConfig1d::Explicit(1, 1)).init(device)
        };
        Self {
            convolutions: vec![convolution(inputs, stride), convolution(outputs, stride)],
            norms: (0..2).map(|_| BatchNormConfig::new(outputs).init(device)).collect(),
        }
    }

    fn forward(&self, series: Tensor<3>) -> Tensor<3> {
        let layers = self.convolutions.iter().zip(&self.norms);
        layers.fold(series, |series, (convolution, norm)| {
            batch_norm_act(norm, Activation::Relu, conv1d(convolution, series))
        })
    }
}
