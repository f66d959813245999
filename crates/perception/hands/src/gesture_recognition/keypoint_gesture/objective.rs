//! Training objective of the gesture classifier: batches, loss and container.

use burn::tensor::Device;
use opendr_datasets::loader::Collate;
use opendr_engine::dataset::Sample;
use opendr_engine::learner::Learner;
use opendr_engine::model::Manifest;
use opendr_engine::params::Params;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, Value};
use opendr_perception_common::labelled::{LabelledBatch, class_of};
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{self, Input};
use opendr_training::{Container, Loss, Objective};

use super::network::{KeypointGestureNetwork, NetworkSizes};
use super::{FILE, KeypointGesture, KeypointGestureParams, check_numbers};

/// Training objective: the cross-entropy.
pub(super) struct GestureObjective<'a> {
    pub sizes: NetworkSizes,
    pub params: &'a KeypointGestureParams,
    pub classes: Classes,
}

impl Objective for GestureObjective<'_> {
    type Network = KeypointGestureNetwork;
    type Collate = RowBatches;

    fn collate(&self) -> Result<RowBatches> {
        Ok(RowBatches { numbers: self.sizes.numbers, classes: self.sizes.classes })
    }

    fn loss(&self, network: &Self::Network, batch: &LabelledBatch, device: &Device) -> Result<Loss> {
        let rows = batch.inputs([1, self.sizes.numbers], device).flatten(1, 2);
        Ok(batch.cross_entropy(network.forward(rows), &[], device).into())
    }

    fn container(&self, network: &Self::Network) -> Result<Container> {
        let input = Input::new("points", [1, self.sizes.numbers]);
        let model = export::onnx(network, input, &["logits"], KeypointGestureNetwork::forward)?;
        let mut manifest = Manifest::new(KeypointGesture::SPEC.name, "");
        manifest.task = Some(KeypointGesture::SPEC.task);
        manifest.params = self.params.to_map();
        manifest.classes.clone_from(&self.classes);
        Ok(Container {
            manifest,
            files: vec![(FILE.into(), model), (TRAINABLE.into(), bytes_from_network(network)?)],
        })
    }
}

/// Collates rows of one length.
pub(super) struct RowBatches {
    numbers: usize,
    classes: usize,
}

impl Collate for RowBatches {
    type Batch = LabelledBatch;

    fn start(&self, capacity: usize) -> LabelledBatch {
        LabelledBatch::with_capacity(capacity, self.numbers)
    }

    fn add(&self, batch: &mut LabelledBatch, sample: Sample) -> Result<()> {
        let row = row_of(&sample)?;
        check_numbers(row, self.numbers)?;
        batch.push(row, class_of(&sample, self.classes)?);
        Ok(())
    }
}

/// Returns the input features of a sample: a vector, or a time series with one feature, as files of rows are read (`ucr`).
pub(super) fn row_of(sample: &Sample) -> Result<&[f32]> {
    match sample.data.first() {
        Some(Value::Vector(vector)) => Ok(vector.as_slice()),
        Some(Value::Timeseries(series)) => Ok(series.as_slice()),
        _ => Err(Error::invalid_input("the sample has no vector; give one, or read the file of rows as ucr")),
    }
}
