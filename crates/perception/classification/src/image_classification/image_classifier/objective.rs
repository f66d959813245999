//! Batches, loss and container.

use burn::tensor::Device;
use opendr_datasets::augment::{Flip, Pipeline, RandomResizedCrop};
use opendr_engine::Result;
use opendr_engine::model::Manifest;
use opendr_engine::target::Classes;
use opendr_perception_common::small_classifier::SmallClassifier;
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{Input, onnx};
use opendr_training::{Container, Loss, Objective};

use super::{SCORES, preprocess};
use crate::labelled_pictures::{LabelledPictures, PictureCollator};

/// Training objective: cross-entropy with label smoothing.
pub struct Classify {
    pub classes: Classes,
    pub side: usize,
    pub crop: f32,
    pub flip: f32,
    pub label_smoothing: f64,
}

impl Objective for Classify {
    type Network = SmallClassifier;
    type Collate = PictureCollator;

    fn collate(&self) -> Result<PictureCollator> {
        Ok(PictureCollator::new(preprocess(self.side), self.classes.len()))
    }

    fn pipeline(&self) -> Result<Pipeline> {
        let mut pipeline = Pipeline::default();
        if self.crop < 1.0 {
            let side = self.side;
            pipeline = pipeline.then(RandomResizedCrop {
                width: side,
                height: side,
                min_area: self.crop,
                ..Default::default()
            })?;
        }
        match self.flip > 0.0 {
            true => pipeline.sometimes(self.flip, Flip::default()),
            false => Ok(pipeline),
        }
    }

    fn loss(&self, network: &SmallClassifier, batch: &LabelledPictures, device: &Device) -> Result<Loss> {
        let scores = network.forward(batch.pictures(device));
        Ok(batch.cross_entropy(scores, self.label_smoothing, device).into())
    }

    fn container(&self, network: &SmallClassifier) -> Result<Container> {
        let input = Input::new("image", [1, 3, self.side, self.side]);
        let model = onnx(network, input, &[SCORES], SmallClassifier::forward)?;
        let mut manifest = Manifest::new("image_classifier", "");
        manifest.classes = self.classes.clone();
        Ok(Container {
            manifest,
            files: vec![
                ("model.onnx".to_owned(), model),
                (TRAINABLE.to_owned(), bytes_from_network(network)?),
            ],
        })
    }
}
