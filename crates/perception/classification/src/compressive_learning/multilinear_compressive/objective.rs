//! Batches, loss and container.

use burn::tensor::Device;
use opendr_datasets::augment::{Flip, Pipeline};
use opendr_engine::Result;
use opendr_engine::learner::Learner as _;
use opendr_engine::model::Manifest;
use opendr_engine::params::Params as _;
use opendr_engine::target::Classes;
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{Input, onnx};
use opendr_training::{Container, Loss, Objective};

use super::network::MultilinearCompressiveNetwork;
use super::{CLASSIFIER, MultilinearCompressive, MultilinearCompressiveParams, preprocess};
use crate::labelled_pictures::{LabelledPictures, PictureCollator};

/// Training objective: cross-entropy.
pub(super) struct CompressiveObjective<'a> {
    pub params: &'a MultilinearCompressiveParams,
    pub classes: Classes,
    /// Shapes `[channels, height, width]` of images and measurements.
    pub pictures: [usize; 3],
    pub measured: [usize; 3],
    pub flip: f32,
}

impl Objective for CompressiveObjective<'_> {
    type Network = MultilinearCompressiveNetwork;
    type Collate = PictureCollator;

    fn collate(&self) -> Result<PictureCollator> {
        let [_, height, width] = self.pictures;
        Ok(PictureCollator::new(preprocess([height, width]), self.classes.len()))
    }

    fn pipeline(&self) -> Result<Pipeline> {
        match self.flip > 0.0 {
            true => Pipeline::default().sometimes(self.flip, Flip::default()),
            false => Ok(Pipeline::default()),
        }
    }

    fn loss(&self, network: &Self::Network, batch: &LabelledPictures, device: &Device) -> Result<Loss> {
        let scores = network.classify(network.measure(batch.pictures(device)));
        Ok(batch.cross_entropy(scores, 0.0, device).into())
    }

    fn container(&self, network: &Self::Network) -> Result<Container> {
        let shape = |[channels, height, width]: [usize; 3]| [1, channels, height, width];
        let image = Input::new("image", shape(self.pictures));
        let sensing = onnx(network, image, &["measurement"], MultilinearCompressiveNetwork::measure)?;
        let measurement = Input::new("measurement", shape(self.measured));
        let classifier = onnx(network, measurement, &["scores"], MultilinearCompressiveNetwork::classify)?;
        let mut manifest = Manifest::new(MultilinearCompressive::SPEC.name, "");
        manifest.task = Some(MultilinearCompressive::SPEC.task);
        manifest.params = self.params.to_map();
        manifest.classes.clone_from(&self.classes);
        Ok(Container {
            manifest,
            files: vec![
                ("model.onnx".into(), sensing),
                (CLASSIFIER.into(), classifier),
                (TRAINABLE.into(), bytes_from_network(network)?),
            ],
        })
    }
}
