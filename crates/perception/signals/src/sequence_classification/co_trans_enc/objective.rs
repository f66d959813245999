//! Batches, loss and container.

use burn::tensor::{Device, Distribution, Int, Tensor};
use opendr_datasets::loader::Collate;
use opendr_engine::data::Timeseries;
use opendr_engine::dataset::Sample;
use opendr_engine::learner::Learner as _;
use opendr_engine::model::Manifest;
use opendr_engine::params::Params as _;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, Value};
use opendr_perception_common::labelled::{LabelledBatch, class_of};
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{self, Input};
use opendr_training::{Container, Loss, Objective};

use super::network::CoTransEncNetwork;
use super::{CoTransEnc, CoTransEncParams, FILE};
use crate::model_checks::check_finite;

/// Training objective: the cross-entropy.
pub(super) struct SequenceObjective<'a> {
    pub params: &'a CoTransEncParams,
    /// Number of features of an input vector.
    pub inputs: usize,
    pub classes: Classes,
}

impl Objective for SequenceObjective<'_> {
    type Network = CoTransEncNetwork;
    type Collate = SequenceBatches;

    fn collate(&self) -> Result<SequenceBatches> {
        let shape = [self.params.sequence_len, self.inputs];
        Ok(SequenceBatches { shape, classes: self.classes.len() })
    }

    fn loss(&self, network: &CoTransEncNetwork, batch: &LabelledBatch, device: &Device) -> Result<Loss> {
        let sequences = batch.inputs([self.params.sequence_len, self.inputs], device);
        let [count, ..] = sequences.dims();
        let positions = Distribution::Uniform(0.0, self.params.positions() as f64);
        let first: Tensor<2, Int> = Tensor::<2>::random([count, 1], positions, device).int();
        Ok(batch.cross_entropy(network.forward(sequences, first), &[], device).into())
    }

    fn container(&self, network: &CoTransEncNetwork) -> Result<Container> {
        let kept = self.params.kept(self.params.token_dims.unwrap_or(self.inputs));
        let inputs = (
            Input::new("vector", [1, self.inputs]),
            Input::int("position", [1]),
            Input::new("memory", [self.params.sequence_len - 1, kept]),
        );
        let model =
            export::onnx(network, inputs, &["logits", "row"], |network, (vector, position, memory)| {
                network.step(vector, position, memory)
            })?;
        let mut manifest = Manifest::new(CoTransEnc::SPEC.name, "");
        manifest.task = Some(CoTransEnc::SPEC.task);
        manifest.params = self.params.to_map();
        manifest.classes.clone_from(&self.classes);
        Ok(Container {
            manifest,
            files: vec![(FILE.into(), model), (TRAINABLE.into(), bytes_from_network(network)?)],
        })
    }
}

/// Batches of sequences `[tokens, features]`, of the last vectors of each series.
pub(super) struct SequenceBatches {
    shape: [usize; 2],
    classes: usize,
}

impl Collate for SequenceBatches {
    type Batch = LabelledBatch;

    fn start(&self, capacity: usize) -> LabelledBatch {
        LabelledBatch::with_capacity(capacity, self.shape.iter().product())
    }

    fn add(&self, batch: &mut LabelledBatch, sample: Sample) -> Result<()> {
        let series = series_of(&sample)?;
        batch.push(&sequence(series, self.shape)?, class_of(&sample, self.classes)?);
        Ok(())
    }
}

/// Returns the series of a sample.
///
/// # Errors
/// `InvalidInput` when its first input is none.
pub(super) fn series_of(sample: &Sample) -> Result<&Timeseries> {
    match sample.data.first() {
        Some(Value::Timeseries(series)) => Ok(series),
        _ => Err(Error::invalid_input(
            "the sample has no time series; the first input must be a Timeseries, as in the format ucr",
        )),
    }
}

/// Returns the last `tokens` vectors of a series, `[tokens, features]`; the first vector of a shorter one is repeated before it.
///
/// # Errors
/// `InvalidInput` for another number of features, and for values that are not finite.
fn sequence(series: &Timeseries, [tokens, features]: [usize; 2]) -> Result<Vec<f32>> {
    let [time, actual] = series.shape();
    if actual != features {
        return Err(Error::invalid_input(format!(
            "the series has vectors of {actual} features, but the first one of the data set has {features}; train on series of \
             equal features"
        )));
    }
    check_finite(series)?;
    let numbers = series.as_slice();
    let repeated = numbers[..features].repeat(tokens.saturating_sub(time));
    Ok([&repeated[..], &numbers[time.saturating_sub(tokens) * features..]].concat())
}
