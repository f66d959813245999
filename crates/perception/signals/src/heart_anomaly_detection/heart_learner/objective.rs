//! Batches, loss and container.

use burn::tensor::Device;
use opendr_datasets::loader::Collate;
use opendr_engine::dataset::Sample;
use opendr_engine::model::Manifest;
use opendr_engine::params::Params as _;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, Value};
use opendr_perception_common::labelled::{LabelledBatch, class_of};
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{self, Input};
use opendr_training::{Container, Loss, Objective};

use super::trainable::{HeartSizes, TrainableHeart};
use super::{FILE, check_series};

/// Training objective: cross-entropy with class weights.
pub(super) struct HeartObjective<'a, K: TrainableHeart> {
    pub sizes: HeartSizes,
    pub params: &'a K::Params,
    pub class_weight: &'a [f32],
    pub classes: Classes,
}

impl<K: TrainableHeart> Objective for HeartObjective<'_, K> {
    type Network = K::Network;
    type Collate = SeriesBatches;

    fn collate(&self) -> Result<SeriesBatches> {
        Ok(SeriesBatches { shape: self.sizes.shape, classes: self.sizes.classes })
    }

    fn loss(&self, network: &Self::Network, batch: &LabelledBatch, device: &Device) -> Result<Loss> {
        let series = batch.inputs(self.sizes.shape, device);
        Ok(batch.cross_entropy(K::forward(network, series), self.class_weight, device).into())
    }

    fn container(&self, network: &Self::Network) -> Result<Container> {
        let [time, features] = self.sizes.shape;
        let input = Input::new("series", [1, time, features]);
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

/// Batches of series `[time, features]` of one shape.
pub(super) struct SeriesBatches {
    shape: [usize; 2],
    classes: usize,
}

impl Collate for SeriesBatches {
    type Batch = LabelledBatch;

    fn start(&self, capacity: usize) -> LabelledBatch {
        LabelledBatch::with_capacity(capacity, self.shape.iter().product())
    }

    fn add(&self, batch: &mut LabelledBatch, sample: Sample) -> Result<()> {
        let Some(Value::Timeseries(series)) = sample.data.first() else {
            return Err(Error::invalid_input(
                "the sample has no time series; the first input must be a Timeseries",
            ));
        };
        check_series(series, self.shape)?;
        batch.push(series.as_slice(), class_of(&sample, self.classes)?);
        Ok(())
    }
}
