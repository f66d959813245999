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
use opendr_perception_common::small_classifier::SmallClassifier;
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{Input, onnx};
use opendr_training::{Container, Loss, Objective};

use super::{CHANNELS, FILE, FrontEnd, RgbdHandGesture, RgbdHandGestureParams, RgbdInputs, Scratch};

/// Training objective: cross-entropy.
pub(super) struct RgbdObjective<'a> {
    pub params: &'a RgbdHandGestureParams,
    pub classes: Classes,
    pub side: usize,
    pub drop_depth: bool,
}

impl Objective for RgbdObjective<'_> {
    type Network = SmallClassifier;
    type Collate = RgbdBatches;

    fn collate(&self) -> Result<RgbdBatches> {
        Ok(RgbdBatches { front_end: FrontEnd::new(self.side), side: self.side, classes: self.classes.len() })
    }

    fn loss(&self, network: &SmallClassifier, batch: &LabelledBatch, device: &Device) -> Result<Loss> {
        let side = self.side;
        let pictures = batch.inputs([CHANNELS, side * side], device);
        let [count, ..] = pictures.dims();
        let pictures = pictures.reshape([count, CHANNELS, side, side]);
        if !self.drop_depth {
            return Ok(batch.cross_entropy(network.forward(pictures), &[], device).into());
        }
        // One batch, so that the statistics of batch normalisation cover both cases, as in inference.
        let colour = pictures.clone().narrow(1, 0, CHANNELS - 1);
        let unknown = Tensor::zeros([count, 1, side, side], device);
        let logits = network.forward(Tensor::cat(vec![pictures, Tensor::cat(vec![colour, unknown], 1)], 0));
        let loss =
            |part: usize| batch.cross_entropy(logits.clone().narrow(0, part * count, count), &[], device);
        Ok(((loss(0) + loss(1)) / 2.0).into())
    }

    fn container(&self, network: &SmallClassifier) -> Result<Container> {
        let input = Input::new("image", [1, CHANNELS, self.side, self.side]);
        let model = onnx(network, input, &["logits"], SmallClassifier::forward)?;
        let mut manifest = Manifest::new(RgbdHandGesture::SPEC.name, "");
        manifest.task = Some(RgbdHandGesture::SPEC.task);
        manifest.params = self.params.to_map();
        manifest.classes.clone_from(&self.classes);
        Ok(Container {
            manifest,
            files: vec![(FILE.into(), model), (TRAINABLE.into(), bytes_from_network(network)?)],
        })
    }
}

/// Batches of images with depth in the network's input layout.
pub(super) struct RgbdBatches {
    front_end: FrontEnd,
    side: usize,
    classes: usize,
}

impl Collate for RgbdBatches {
    type Batch = LabelledBatch;

    fn start(&self, capacity: usize) -> LabelledBatch {
        LabelledBatch::with_capacity(capacity, CHANNELS * self.side * self.side)
    }

    fn add(&self, batch: &mut LabelledBatch, sample: Sample) -> Result<()> {
        let [Value::Image(image), Value::Image(depth)] = &sample.data[..] else {
            return Err(Error::invalid_input(
                "the sample does not have two inputs; they must be an image and its depth",
            ));
        };
        let mut scratch = Scratch::default();
        self.front_end.run(&RgbdInputs { image, depth }, &mut scratch)?;
        batch.push(&scratch.input, class_of(&sample, self.classes)?);
        Ok(())
    }
}
