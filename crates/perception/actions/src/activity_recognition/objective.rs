//! Batches, loss and container of both learners.

use burn::tensor::{Device, Tensor};
use opendr_datasets::augment::{Augment, OtherSamples, Pipeline};
use opendr_datasets::loader::Collate;
use opendr_engine::data::Video;
use opendr_engine::dataset::Sample;
use opendr_engine::model::Manifest;
use opendr_engine::params::ParamMap;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Random, Result, Task, Value};
use opendr_perception_common::clip_frames::ClipFrames;
use opendr_perception_common::labelled::{LabelledBatch, class_of};
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{self, Input};
use opendr_training::{Container, Loss, Objective};

use super::Sizes;
use super::network::ActivityNetwork;
use super::time::{Kept, Time};

/// Training objective: cross-entropy.
pub(super) struct ActivityObjective {
    pub sizes: Sizes,
    pub form: Form,
    pub params: ParamMap,
    pub classes: Classes,
    /// Whether clips are mirrored at random.
    pub augment: bool,
}

/// Form of the network in the container.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// `clip` to `logits`.
    Clip,
    /// `frame`, `state` and `is_first` to `logits` and the next `state`.
    Step,
}

/// File of the network in every container.
const FILE: &str = "model.onnx";

impl Objective for ActivityObjective {
    type Network = ActivityNetwork;
    type Collate = VideoBatches;

    fn pipeline(&self) -> Result<Pipeline> {
        Pipeline::default().push("mirror", if self.augment { 0.5 } else { 0.0 }, Box::new(Mirror))
    }

    fn collate(&self) -> Result<VideoBatches> {
        let Sizes { frames, side, .. } = self.sizes;
        let size = frames * 3 * side * side;
        Ok(VideoBatches { frames: ClipFrames::new(side, frames), size, classes: self.classes.len() })
    }

    fn loss(&self, network: &Self::Network, batch: &LabelledBatch, device: &Device) -> Result<Loss> {
        let Sizes { frames, side, .. } = self.sizes;
        let clips = batch.inputs([frames, 3 * side * side], device);
        let [count, ..] = clips.dims();
        let logits =
            network.forward(clips.reshape([count * frames, 3, side, side]), &mut Time::Clips(frames));
        Ok(batch.cross_entropy(logits, &[], device).into())
    }

    fn container(&self, network: &Self::Network) -> Result<Container> {
        let Sizes { frames, side, .. } = self.sizes;
        let (name, model) = match self.form {
            Form::Clip => {
                let input = Input::new("clip", [frames, 3, side, side]);
                let model = export::onnx(network, input, &["logits"], |network, clip| {
                    network.forward(clip, &mut Time::Clips(frames))
                })?;
                ("x3d", model)
            }
            Form::Step => {
                let frame = Input::new("frame", [1, 3, side, side]);
                let state = Input::new("state", [1, self.state(network)]);
                let inputs = (frame, state, Input::new("is_first", [1, 1]));
                let names = ["logits", "next_state"];
                let model = export::onnx(network, inputs, &names, |network, (frame, state, is_first)| {
                    let kept = Kept { frames, state, is_first, at: 0, next: Vec::new() };
                    let mut time = Time::Stream(Box::new(kept));
                    let logits = network.forward(frame, &mut time);
                    match time {
                        Time::Stream(kept) => (logits, Tensor::cat(kept.next, 1)),
                        _ => (logits.clone(), logits),
                    }
                })?;
                ("co_x3d", model)
            }
        };
        let mut manifest = Manifest::new(name, "");
        manifest.task = Some(Task::ActivityRecognition);
        manifest.params.clone_from(&self.params);
        manifest.classes.clone_from(&self.classes);
        Ok(Container {
            manifest,
            files: vec![(FILE.into(), model), (TRAINABLE.into(), bytes_from_network(network)?)],
        })
    }
}

impl ActivityObjective {
    /// Returns the length of a stream's state vector.
    fn state(&self, network: &ActivityNetwork) -> usize {
        let Sizes { frames, side, .. } = self.sizes;
        let mut time = Time::Count { frames, numbers: 0 };
        let network = burn::module::Module::valid(network);
        let black = Tensor::zeros([1, 3, side, side], &Device::flex());
        network.forward(black, &mut time);
        match time {
            Time::Count { numbers, .. } => numbers,
            _ => 0,
        }
    }
}

/// Mirrors a clip horizontally.
struct Mirror;

impl Augment for Mirror {
    fn apply(&self, sample: &mut Sample, _: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let video = video_of(sample)?;
        let shape = video.shape();
        let mut levels = video.as_slice().to_vec();
        levels.chunks_exact_mut(shape[3]).for_each(<[f32]>::reverse);
        sample.data = vec![Value::Video(Video::new(levels, shape)?)];
        Ok(())
    }
}

fn video_of(sample: &Sample) -> Result<&Video> {
    match sample.data.first() {
        Some(Value::Video(video)) => Ok(video),
        _ => Err(Error::invalid_input("the sample has no video; the first input must be a Video")),
    }
}

/// Batches of clips in the network's input layout.
pub(super) struct VideoBatches {
    frames: ClipFrames,
    size: usize,
    classes: usize,
}

impl Collate for VideoBatches {
    type Batch = LabelledBatch;

    fn start(&self, capacity: usize) -> LabelledBatch {
        LabelledBatch::with_capacity(capacity, self.size)
    }

    fn add(&self, batch: &mut LabelledBatch, sample: Sample) -> Result<()> {
        let mut input = Vec::new();
        self.frames.clip_into(video_of(&sample)?, &mut input)?;
        batch.push(&input, class_of(&sample, self.classes)?);
        Ok(())
    }
}
