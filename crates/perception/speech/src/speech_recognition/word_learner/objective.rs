//! Augmentation, batches, loss and container.

use burn::tensor::Device;
use opendr_audio::AudioInput;
use opendr_datasets::augment::{
    AudioGain, AudioNoise, AudioShift, Augment, OtherSamples, Pipeline, SpecAugment,
};
use opendr_datasets::loader::Collate;
use opendr_engine::data::{Audio, Timeseries};
use opendr_engine::dataset::Sample;
use opendr_engine::model::Manifest;
use opendr_engine::params::Params;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Random, Result, Value};
use opendr_perception_common::labelled::{LabelledBatch, class_of};
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{self, Input};
use opendr_training::{Container, Loss, Objective};

use super::trainable::TrainableWords;
use super::{FILE, WordParams};
use crate::speech_recognition::cepstra::{FRAMES, FrontEnd};

/// Training objective: cross-entropy.
pub(super) struct WordObjective<'a, K: TrainableWords> {
    pub params: &'a K::Params,
    pub classes: Classes,
    /// Whether audio and cepstra are augmented at random.
    pub augment: bool,
}

impl<K: TrainableWords> Objective for WordObjective<'_, K> {
    type Network = K::Network;
    type Collate = CepstraBatches;

    fn pipeline(&self) -> Result<Pipeline> {
        let WordParams { preprocess_to_mfcc, sample_rate, .. } = *K::words(self.params);
        let masks = SpecAugment { max_time: 8, max_frequency: K::COEFFICIENTS / 8, ..SpecAugment::default() };
        let (changed, often) = if self.augment { (0.5, 0.8) } else { (0.0, 0.0) };
        let pipeline = Pipeline::default();
        let pipeline = match preprocess_to_mfcc {
            true => {
                let coefficients = K::COEFFICIENTS;
                let front_end = FrontEnd::new(true, sample_rate, coefficients)?;
                pipeline
                    .push("sound", 1.0, Box::new(ToSound { sample_rate }))?
                    .sometimes(often, AudioShift { max_shift: 0.15 })?
                    .sometimes(changed, AudioGain::default())?
                    .sometimes(changed, AudioNoise { min_snr: 5.0, max_snr: 40.0 })?
                    .push("cepstra", 1.0, Box::new(ToCepstra { front_end, coefficients }))?
            }
            false => pipeline,
        };
        pipeline.sometimes(often, masks)
    }

    fn collate(&self) -> Result<CepstraBatches> {
        let coefficients = K::COEFFICIENTS;
        let front_end = FrontEnd::new(false, K::words(self.params).sample_rate, coefficients)?;
        Ok(CepstraBatches { front_end, coefficients, classes: self.classes.len() })
    }

    fn loss(&self, network: &Self::Network, batch: &LabelledBatch, device: &Device) -> Result<Loss> {
        let cepstra = batch.inputs([K::COEFFICIENTS, FRAMES], device);
        Ok(batch.cross_entropy(K::forward(network, cepstra), &[], device).into())
    }

    fn container(&self, network: &Self::Network) -> Result<Container> {
        let input = Input::new("cepstra", [1, K::COEFFICIENTS, FRAMES]);
        let model = export::onnx(network, input, &["logits"], K::forward)?;
        let mut manifest = Manifest::new(K::SPEC.name, "");
        manifest.task = Some(K::SPEC.task);
        manifest.params = self.params.to_map();
        manifest.classes.clone_from(&self.classes);
        Ok(Container {
            manifest,
            files: vec![(FILE.into(), model), (TRAINABLE.into(), bytes_from_network(network)?)],
        })
    }
}

/// Converts an audio input to an [`Audio`] of one channel.
struct ToSound {
    sample_rate: u32,
}

impl Augment for ToSound {
    fn apply(&self, sample: &mut Sample, _: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let samples = sound_of(sample)?.samples(self.sample_rate)?.into_owned();
        sample.data = vec![Value::Audio(Audio::new(samples, 1, self.sample_rate)?)];
        Ok(())
    }
}

/// Converts audio to a [`Timeseries`] of its cepstra.
struct ToCepstra {
    front_end: FrontEnd,
    coefficients: usize,
}

impl Augment for ToCepstra {
    fn apply(&self, sample: &mut Sample, _: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let mut cepstra = Vec::new();
        self.front_end.cepstra_into(sound_of(sample)?, &mut cepstra)?;
        let shape = [cepstra.len() / self.coefficients, self.coefficients];
        sample.data = vec![Value::Timeseries(Timeseries::new(cepstra, shape)?)];
        Ok(())
    }
}

fn sound_of(sample: &Sample) -> Result<AudioInput<'_>> {
    match sample.data.first() {
        Some(Value::Audio(audio)) => Ok(AudioInput::Audio(audio)),
        Some(Value::Timeseries(series)) => Ok(AudioInput::Series(series)),
        _ => Err(Error::invalid_input(
            "the sample has no audio; the first input must be Audio or a Timeseries",
        )),
    }
}

/// Batches of cepstra in the network's input layout.
pub(super) struct CepstraBatches {
    front_end: FrontEnd,
    coefficients: usize,
    classes: usize,
}

impl Collate for CepstraBatches {
    type Batch = LabelledBatch;

    fn start(&self, capacity: usize) -> LabelledBatch {
        LabelledBatch::with_capacity(capacity, self.coefficients * FRAMES)
    }

    fn add(&self, batch: &mut LabelledBatch, sample: Sample) -> Result<()> {
        let mut input = Vec::new();
        self.front_end.input_into(sound_of(&sample)?, &mut input)?;
        batch.push(&input, class_of(&sample, self.classes)?);
        Ok(())
    }
}
