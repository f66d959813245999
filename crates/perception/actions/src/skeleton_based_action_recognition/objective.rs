//! Batches, loss and container of the learners.

use burn::tensor::Device;
use opendr_datasets::augment::Pipeline;
use opendr_datasets::loader::Collate;
use opendr_engine::dataset::Sample;
use opendr_engine::model::Manifest;
use opendr_engine::params::ParamMap;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, Task, Value};
use opendr_perception_common::frame_features::{ClipScratch, FrameFeatures};
use opendr_perception_common::labelled::{LabelledBatch, class_of};
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{self, Input};
use opendr_training::{Container, Loss, Objective};

use super::augment::SkeletonChanges;
use super::network::ActionNetwork;
use super::sizes::NetworkSizes;

/// Training objective: cross-entropy with label smoothing.
pub(super) struct ActionObjective {
    /// Name of the learner.
    pub learner: &'static str,
    pub sizes: NetworkSizes,
    pub form: Form,
    pub params: ParamMap,
    pub classes: Classes,
    /// Weight of the uniform distribution in the target.
    pub smoothing: f32,
    /// Whether skeletons are augmented at random.
    pub augment: bool,
}

/// Form of the network in the container.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// `clip` to `logits`.
    Clip,
    /// `frame` and `state` to `logits` and the next `state`.
    Step,
}

/// File of the network in every container.
pub(super) const FILE: &str = "model.onnx";

impl Objective for ActionObjective {
    type Network = ActionNetwork;
    type Collate = ClipBatches;

    fn pipeline(&self) -> Result<Pipeline> {
        let NetworkSizes { graph, coordinates, .. } = self.sizes;
        let changes = SkeletonChanges {
            skeleton: graph.skeleton(),
            coordinates,
            features: FrameFeatures::new(graph.parents(), coordinates),
        };
        Pipeline::default().push("skeleton_changes", f32::from(u8::from(self.augment)), Box::new(changes))
    }

    fn collate(&self) -> Result<ClipBatches> {
        Ok(ClipBatches {
            features: FrameFeatures::new(self.sizes.graph.parents(), self.sizes.coordinates),
            frames: self.sizes.frames,
            classes: self.classes.len(),
        })
    }

    fn loss(&self, network: &Self::Network, batch: &LabelledBatch, device: &Device) -> Result<Loss> {
        let (features, frames, joints) =
            (self.sizes.features(), self.sizes.frames, self.sizes.graph.joints());
        let clips = batch.inputs([features, frames * joints], device);
        let [count, ..] = clips.dims();
        let logits = network.forward(clips.reshape([count, features, frames, joints]));
        let loss = batch.cross_entropy(logits.clone(), &[], device);
        // Label smoothing: the mean cross-entropy with the uniform distribution.
        let uniform = burn::tensor::activation::log_softmax(logits, 1).mean().neg();
        Ok((loss * (1.0 - self.smoothing) + uniform * self.smoothing).into())
    }

    fn container(&self, network: &Self::Network) -> Result<Container> {
        let (features, joints) = (self.sizes.features(), self.sizes.graph.joints());
        let model = match self.form {
            Form::Clip => {
                let input = Input::new("clip", [1, features, self.sizes.frames, joints]);
                export::onnx(network, input, &["logits"], ActionNetwork::forward)?
            }
            Form::Step => {
                let frame = Input::new("frame", [1, features, 1, joints]);
                let state = Input::new("state", [1, self.sizes.state()?]);
                let names = ["logits", "next_state"];
                export::onnx(network, (frame, state), &names, |network, (frame, state)| {
                    network.step(frame, state)
                })?
            }
        };
        let mut manifest = Manifest::new(self.learner, "");
        manifest.task = Some(Task::SkeletonBasedActionRecognition);
        manifest.params.clone_from(&self.params);
        manifest.inputs = self.inputs();
        manifest.classes.clone_from(&self.classes);
        Ok(Container {
            manifest,
            files: vec![(FILE.into(), model), (TRAINABLE.into(), bytes_from_network(network)?)],
        })
    }
}

impl ActionObjective {
    /// Describes the skeletons of the input, for programs that build them from poses.
    fn inputs(&self) -> serde_json::Map<String, serde_json::Value> {
        let NetworkSizes { graph, coordinates, frames, .. } = self.sizes;
        let frames = if self.form == Form::Clip { frames } else { 1 };
        let sequence = serde_json::json!({
            "layout": "NCTVM",
            "skeleton": graph.skeleton().name(),
            "channels": coordinates,
            "frames": frames,
            "persons": self.params.get("num_person"),
        });
        [("skeleton_sequence".to_owned(), sequence)].into_iter().collect()
    }
}

/// Batches of clip features of one length, from the first person present in a recording.
pub(super) struct ClipBatches {
    features: FrameFeatures,
    frames: usize,
    classes: usize,
}

impl Collate for ClipBatches {
    type Batch = LabelledBatch;

    fn start(&self, capacity: usize) -> LabelledBatch {
        LabelledBatch::with_capacity(capacity, self.frames * self.features.frame_len())
    }

    fn add(&self, batch: &mut LabelledBatch, sample: Sample) -> Result<()> {
        let Some(Value::SkeletonSequence(sequence)) = sample.data.first() else {
            return Err(Error::invalid_input(
                "the sample has no skeletons; the first input must be a SkeletonSequence",
            ));
        };
        self.features.check(sequence)?;
        let mut work = ClipScratch::default();
        let persons = sequence.shape()[4];
        if !(0..persons).any(|person| self.features.clip_into(sequence, person, self.frames, &mut work)) {
            return Err(Error::invalid_input("the recording has no person; remove it from the data set"));
        }
        batch.push(&work.clip, class_of(&sample, self.classes)?);
        Ok(())
    }
}
