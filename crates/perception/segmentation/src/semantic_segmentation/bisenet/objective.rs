//! Batches of images with class maps, and the cross-entropy per pixel.

use burn::tensor::activation::log_softmax;
use burn::tensor::{Device, Int, Tensor, TensorData};
use opendr_datasets::augment::{Flip, Pipeline, RandomResizedCrop};
use opendr_datasets::loader::{Collate, ImageBatch, ImageBatches};
use opendr_engine::dataset::Sample;
use opendr_engine::learner::Learner as _;
use opendr_engine::model::Manifest;
use opendr_engine::target::{Classes, HeatmapValues};
use opendr_engine::{Error, Result, Value};
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{Input, onnx};
use opendr_training::{Container, Loss, Objective};

use super::network::BisenetNetwork;
use super::{Bisenet, preprocess};
use crate::semantic_segmentation::nearest;

/// Class of ignored pixels.
const IGNORED: u32 = 255;

/// Training objective: cross-entropy per pixel.
pub(super) struct SegmentPixels {
    pub classes: Classes,
    /// Height and width of the network's input.
    pub size: [usize; 2],
    pub crop: f32,
    pub flip: f32,
}

/// Collates [`MappedPictures`].
pub(super) struct MapCollator {
    pictures: ImageBatches,
    size: [usize; 2],
    classes: usize,
}

/// Batch of images and the class of each of their pixels.
pub(super) struct MappedPictures {
    pictures: ImageBatch,
    classes: Vec<i64>,
    weights: Vec<f32>,
}

impl Collate for MapCollator {
    type Batch = MappedPictures;

    fn start(&self, capacity: usize) -> MappedPictures {
        let pixels = capacity * self.size[0] * self.size[1];
        MappedPictures {
            pictures: self.pictures.start(capacity),
            classes: Vec::with_capacity(pixels),
            weights: Vec::with_capacity(pixels),
        }
    }

    fn add(&self, batch: &mut MappedPictures, sample: Sample) -> Result<()> {
        let map = match &sample.target {
            Some(Value::Heatmap(map)) => map.clone(),
            _ => {
                return Err(Error::invalid_input(
                    "the sample has no class map; the target must be a Heatmap of classes",
                ));
            }
        };
        let (&[rows, columns], HeatmapValues::Labels(labels)) = (map.shape(), map.values()) else {
            return Err(Error::invalid_input("the sample's map is not a class map [height, width]"));
        };
        if labels.is_empty() {
            return Err(Error::invalid_input("the sample's class map has no pixel"));
        }
        self.pictures.add(&mut batch.pictures, sample)?;
        let [height, width] = self.size;
        for y in 0..height {
            let from = nearest(y, height, rows) * columns;
            for x in 0..width {
                let label = labels[from + nearest(x, width, columns)];
                if label != IGNORED && label as usize >= self.classes {
                    return Err(Error::invalid_input(format!(
                        "a pixel has class {label}, but the network has {} classes from 0; correct the data set",
                        self.classes
                    )));
                }
                batch.classes.push(if label == IGNORED { 0 } else { i64::from(label) });
                batch.weights.push(if label == IGNORED { 0.0 } else { 1.0 });
            }
        }
        Ok(())
    }
}

impl Objective for SegmentPixels {
    type Network = BisenetNetwork;
    type Collate = MapCollator;

    fn collate(&self) -> Result<MapCollator> {
        let pictures = ImageBatches::new(preprocess(self.size));
        Ok(MapCollator { pictures, size: self.size, classes: self.classes.len() })
    }

    fn pipeline(&self) -> Result<Pipeline> {
        let [height, width] = self.size;
        let mut pipeline = Pipeline::default();
        if self.crop < 1.0 {
            let crop = RandomResizedCrop { width, height, min_area: self.crop, ..Default::default() };
            pipeline = pipeline.then(crop)?;
        }
        match self.flip > 0.0 {
            true => pipeline.sometimes(self.flip, Flip::default()),
            false => Ok(pipeline),
        }
    }

    fn loss(&self, network: &BisenetNetwork, batch: &MappedPictures, device: &Device) -> Result<Loss> {
        let pictures = TensorData::new(batch.pictures.values().to_vec(), batch.pictures.shape());
        let scores = network.forward(Tensor::from_data(pictures, device));
        let (pixels, count) = (batch.classes.len(), self.classes.len());
        let scores = scores.swap_dims(1, 2).swap_dims(2, 3).reshape([pixels, count]);
        let classes = TensorData::new(batch.classes.clone(), [pixels, 1]);
        let weights = TensorData::new(batch.weights.clone(), [pixels, 1]);
        let likely = log_softmax(scores, 1).gather(1, Tensor::<2, Int>::from_data(classes, device));
        let counted = batch.weights.iter().sum::<f32>().max(1.0);
        let loss = (likely * Tensor::<2>::from_data(weights, device)).sum() / (-counted);
        Ok(loss.into())
    }

    fn container(&self, network: &BisenetNetwork) -> Result<Container> {
        let [height, width] = self.size;
        let input = Input::new("image", [1, 3, height, width]);
        let model = onnx(network, input, &["scores"], BisenetNetwork::forward)?;
        let mut manifest = Manifest::new(Bisenet::SPEC.name, "");
        manifest.task = Some(Bisenet::SPEC.task);
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
