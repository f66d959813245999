//! Training objective of PST-BLN: batches, loss and container.

use burn::tensor::Device;
use opendr_datasets::loader::Collate;
use opendr_engine::data::SkeletonSequence;
use opendr_engine::dataset::Sample;
use opendr_engine::learner::Learner as _;
use opendr_engine::model::Manifest;
use opendr_engine::params::Params as _;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, Value};
use opendr_perception_common::frame_features::{ClipScratch, FrameFeatures};
use opendr_perception_common::labelled::{LabelledBatch, class_of};
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{Input, onnx};
use opendr_training::{Container, Loss, Objective};

use super::network::{BilinearNetwork, NetworkSizes};
use super::{FILE, ProgressiveSpatioTemporalBln, ProgressiveSpatioTemporalBlnParams, first_face_into};

/// Training objective of PST-BLN: the cross-entropy.
pub(super) struct ExpressionObjective<'a> {
    pub params: &'a ProgressiveSpatioTemporalBlnParams,
    pub classes: Classes,
    pub sizes: NetworkSizes,
}

impl Objective for ExpressionObjective<'_> {
    type Network = BilinearNetwork;
    type Collate = LandmarkBatches;

    fn collate(&self) -> Result<LandmarkBatches> {
        Ok(LandmarkBatches {
            features: FrameFeatures::without_bones(self.sizes.points, self.params.in_channels),
            frames: self.sizes.frames,
            classes: self.classes.len(),
        })
    }

    fn loss(&self, network: &BilinearNetwork, batch: &LabelledBatch, device: &Device) -> Result<Loss> {
        let NetworkSizes { features, frames, points, .. } = self.sizes;
        let clips = batch.inputs([features, frames * points], device);
        let [count, ..] = clips.dims();
        let logits = network.forward(clips.reshape([count, features, frames, points]));
        Ok(batch.cross_entropy(logits, &[], device).into())
    }

    fn container(&self, network: &BilinearNetwork) -> Result<Container> {
        let NetworkSizes { features, frames, points, .. } = self.sizes;
        let input = Input::new("clip", [1, features, frames, points]);
        let model = onnx(network, input, &["logits"], BilinearNetwork::forward)?;
        let mut manifest = Manifest::new(ProgressiveSpatioTemporalBln::SPEC.name, "");
        manifest.task = Some(ProgressiveSpatioTemporalBln::SPEC.task);
        manifest.params = self.params.to_map();
        manifest.classes.clone_from(&self.classes);
        Ok(Container {
            manifest,
            files: vec![(FILE.into(), model), (TRAINABLE.into(), bytes_from_network(network)?)],
        })
    }
}

/// Collates sequences into features of clips of one length.
pub(super) struct LandmarkBatches {
    features: FrameFeatures,
    frames: usize,
    classes: usize,
}

impl Collate for LandmarkBatches {
    type Batch = LabelledBatch;

    fn start(&self, capacity: usize) -> LabelledBatch {
        LabelledBatch::with_capacity(capacity, self.frames * self.features.frame_len())
    }

    fn add(&self, batch: &mut LabelledBatch, sample: Sample) -> Result<()> {
        let sequence = sequence_of(&sample)?;
        self.features.check(sequence)?;
        let mut work = ClipScratch::default();
        first_face_into(&self.features, sequence, self.frames, &mut work)?;
        batch.push(&work.clip, class_of(&sample, self.classes)?);
        Ok(())
    }
}

/// Returns the landmarks of a sample.
pub(super) fn sequence_of(sample: &Sample) -> Result<&SkeletonSequence> {
    match sample.data.first() {
        Some(Value::SkeletonSequence(sequence)) => Ok(sequence),
        _ => Err(Error::invalid_input("the sample has no landmarks; give a SkeletonSequence")),
    }
}
