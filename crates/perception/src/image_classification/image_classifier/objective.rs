//! What it is trained on and by: pictures with classes, cross entropy.

use burn::nn::loss::{CrossEntropyLoss, CrossEntropyLossConfig};
use burn::tensor::{Device, Int, Tensor, TensorData};
use opendr_datasets::augment::{Flip, Pipeline, RandomResizedCrop};
use opendr_datasets::loader::{Collate, ImageBatch, ImageBatches};
use opendr_engine::Result;
use opendr_engine::dataset::Sample;
use opendr_engine::model::Manifest;
use opendr_engine::target::Classes;
use opendr_training::export::{Input, onnx};
use opendr_training::{Container, Loss, Objective};

use super::network::Network;
use super::{SCORES, preprocess};
use crate::labelled::class_of;
use crate::trainable_weights::{TRAINABLE, bytes_from_network};

/// Pictures with classes, cross entropy.
pub struct Classify {
    pub classes: Classes,
    pub side: usize,
    pub crop: f32,
    pub flip: f32,
    pub label_smoothing: f64,
}

/// Makes [`ClassifiedPictures`].
pub struct Collator {
    pictures: ImageBatches,
    classes: usize,
}

/// Pictures and the number of the class of each.
pub struct ClassifiedPictures {
    pictures: ImageBatch,
    classes: Vec<i64>,
}

impl Collate for Collator {
    type Batch = ClassifiedPictures;

    fn start(&self, capacity: usize) -> ClassifiedPictures {
        ClassifiedPictures { pictures: self.pictures.start(capacity), classes: Vec::with_capacity(capacity) }
    }

    fn add(&self, batch: &mut ClassifiedPictures, sample: Sample) -> Result<()> {
        let class = class_of(&sample, self.classes)?;
        self.pictures.add(&mut batch.pictures, sample)?;
        batch.classes.push(class);
        Ok(())
    }
}

impl Objective for Classify {
    type Network = Network;
    type Collate = Collator;

    fn collate(&self) -> Result<Collator> {
        Ok(Collator { pictures: ImageBatches::new(preprocess(self.side)), classes: self.classes.len() })
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

    fn loss(&self, network: &Network, batch: &ClassifiedPictures, device: &Device) -> Result<Loss> {
        let ClassifiedPictures { pictures, classes } = batch;
        let images =
            Tensor::<4>::from_data(TensorData::new(pictures.values().to_vec(), pictures.shape()), device);
        let wanted = Tensor::<1, Int>::from_data(TensorData::new(classes.clone(), [classes.len()]), device);
        let loss: CrossEntropyLoss = CrossEntropyLossConfig::new()
            .with_smoothing((self.label_smoothing > 0.0).then_some(self.label_smoothing as f32))
            .init(device);
        Ok(loss.forward(network.forward(images), wanted).into())
    }

    fn container(&self, network: &Network) -> Result<Container> {
        let input = Input::new("image", [1, 3, self.side, self.side]);
        let model = onnx(network, input, &[SCORES], Network::forward)?;
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
