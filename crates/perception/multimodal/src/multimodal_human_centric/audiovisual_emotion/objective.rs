//! Batches, loss and container.

use burn::tensor::{Device, Tensor};
use opendr_datasets::loader::Collate;
use opendr_engine::dataset::Sample;
use opendr_engine::learner::Learner as _;
use opendr_engine::model::Manifest;
use opendr_engine::params::Params as _;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, Value};
use opendr_perception_common::labelled::{LabelledBatch, class_of};
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{Input, onnx};
use opendr_training::{Container, Loss, Objective};

use super::front_end::{FrontEnd, Sizes};
use super::network::AudiovisualNetwork;
use super::{AudiovisualEmotion, AudiovisualEmotionParams, FILE, ModalityDrop, Scratch};

/// Training objective: cross-entropy with both modalities and, with [`ModalityDrop::Zero`], with each alone.
pub(super) struct AudiovisualObjective<'a> {
    pub params: &'a AudiovisualEmotionParams,
    pub classes: Classes,
    pub sizes: Sizes,
    pub mod_drop: ModalityDrop,
}

impl Objective for AudiovisualObjective<'_> {
    type Network = AudiovisualNetwork;
    type Collate = AudiovisualBatches;

    fn collate(&self) -> Result<AudiovisualBatches> {
        Ok(AudiovisualBatches { front_end: FrontEnd::new(&self.sizes)?, classes: self.classes.len() })
    }

    fn loss(&self, network: &AudiovisualNetwork, batch: &LabelledBatch, device: &Device) -> Result<Loss> {
        let Sizes { frames, side, instants, .. } = self.sizes;
        let (sound, faces) = (self.sizes.audio(), self.sizes.video());
        let both = batch.inputs([1, sound + faces], device);
        let [count, ..] = both.dims();
        let audio = both.clone().narrow(2, 0, sound).reshape([count, Sizes::COEFFICIENTS, instants]);
        let video = both.narrow(2, sound, faces).reshape([count * frames, 3, side, side]);
        if self.mod_drop == ModalityDrop::None {
            return Ok(batch.cross_entropy(network.forward(audio, video), &[], device).into());
        }
        // One batch, so that the statistics of batch normalisation cover all three cases, as in inference.
        let audio = Tensor::cat(vec![audio.clone(), audio.zeros_like(), audio], 0);
        let video = Tensor::cat(vec![video.clone(), video.clone(), video.zeros_like()], 0);
        let logits = network.forward(audio, video);
        let loss =
            |part: usize| batch.cross_entropy(logits.clone().narrow(0, part * count, count), &[], device);
        Ok(((loss(0) + loss(1) + loss(2)) / 3.0).into())
    }

    fn container(&self, network: &AudiovisualNetwork) -> Result<Container> {
        let Sizes { frames, side, instants, .. } = self.sizes;
        let audio = Input::new("audio", [1, Sizes::COEFFICIENTS, instants]);
        let video = Input::new("video", [frames, 3, side, side]);
        let forward = |network: &AudiovisualNetwork, (audio, video)| network.forward(audio, video);
        let model = onnx(network, (audio, video), &["logits"], forward)?;
        let mut manifest = Manifest::new(AudiovisualEmotion::SPEC.name, "");
        manifest.task = Some(AudiovisualEmotion::SPEC.task);
        manifest.params = self.params.to_map();
        manifest.classes.clone_from(&self.classes);
        Ok(Container {
            manifest,
            files: vec![(FILE.into(), model), (TRAINABLE.into(), bytes_from_network(network)?)],
        })
    }
}

/// Batches of audio followed by faces.
pub(super) struct AudiovisualBatches {
    front_end: FrontEnd,
    classes: usize,
}

impl Collate for AudiovisualBatches {
    type Batch = LabelledBatch;

    fn start(&self, capacity: usize) -> LabelledBatch {
        LabelledBatch::with_capacity(capacity, self.front_end.sizes.audio() + self.front_end.sizes.video())
    }

    fn add(&self, batch: &mut LabelledBatch, sample: Sample) -> Result<()> {
        let (audio, video) = match &sample.data[..] {
            [Value::Audio(audio), Value::Video(video)] => (audio, Some(video)),
            [Value::Audio(audio)] => (audio, None),
            _ => {
                return Err(Error::invalid_input(
                    "the sample has no audio; its inputs must be Audio and, optionally, Video",
                ));
            }
        };
        let Scratch { audio: mut input, video: mut faces } = Scratch::default();
        self.front_end.audio_into(audio, &mut input)?;
        self.front_end.video_into(video, &mut faces)?;
        input.append(&mut faces);
        batch.push(&input, class_of(&sample, self.classes)?);
        Ok(())
    }
}
