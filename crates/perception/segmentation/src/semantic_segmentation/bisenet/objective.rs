//! Batches of images with class maps, and the cross-entropy per pixel.

use burn::tensor::activation::log_softmax;
use burn::tensor::{Device, Int, Tensor, TensorData};
use opendr_datasets::augment::{Colour, Flip, Pipeline, RandomResizedCrop};
use opendr_datasets::loader::{Collate, ImageBatch, ImageBatches};
use opendr_engine::dataset::{DatasetIterator, Sample};
use opendr_engine::learner::{FitJob, Learner as _};
use opendr_engine::model::Manifest;
use opendr_engine::target::{Classes, HeatmapValues};
use opendr_engine::{Error, Result, Unit, Value};
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
    pub colour: f32,
    /// Weight of the pixels of each class.
    pub weights: Vec<f32>,
}

/// Collates [`MappedPictures`].
pub(super) struct MapCollator {
    pictures: ImageBatches,
    size: [usize; 2],
    class_weights: Vec<f32>,
}

/// Batch of images and the class of each of their pixels.
pub(super) struct MappedPictures {
    pictures: ImageBatch,
    classes: Vec<i64>,
    weights: Vec<f32>,
}

/// Number of samples whose pixels are counted for the weights of the classes.
const COUNTED: usize = 400;

/// Returns the weight of each of `classes` classes: its share of the annotated pixels to the power of `-balance`, scaled so
/// that the mean over the pixels is 1. A class without a pixel has the weight of the rarest of the others.
pub(super) fn class_weights(
    dataset: &dyn DatasetIterator,
    classes: usize,
    balance: f64,
    job: &FitJob<'_>,
) -> Result<Vec<f32>> {
    if balance == 0.0 {
        return Ok(vec![1.0; classes]);
    }
    let mut pixels = vec![0_u64; classes];
    let step = dataset.len().div_ceil(COUNTED).max(1);
    job.progress.begin("counting pixels", Some(dataset.len().div_ceil(step) as u64), Unit::Items);
    for index in (0..dataset.len()).step_by(step) {
        job.progress.advance(1);
        // Samples without a map are reported by the loader, or skipped by it.
        let Ok(Sample { target: Some(Value::Heatmap(map)), .. }) = dataset.get(index) else { continue };
        let HeatmapValues::Labels(labels) = map.values() else { continue };
        for &label in labels.iter() {
            if let Some(count) = pixels.get_mut(label as usize) {
                *count += 1;
            }
        }
    }
    job.progress.end();
    let rarest = pixels.iter().copied().filter(|count| *count > 0).min().unwrap_or(1);
    let all = pixels.iter().sum::<u64>().max(1) as f64;
    let shares = pixels.iter().map(|&count| count.max(rarest) as f64 / all);
    let weights: Vec<f64> = shares.clone().map(|share| share.powf(-balance)).collect();
    let mean: f64 = shares.zip(&weights).map(|(share, weight)| share * weight).sum();
    Ok(weights.into_iter().map(|weight| (weight / mean) as f32).collect())
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
                let (class, weight) = match self.class_weights.get(label as usize) {
                    Some(weight) => (i64::from(label), *weight),
                    None if label == IGNORED => (0, 0.0),
                    None => {
                        return Err(Error::invalid_input(format!(
                            "a pixel has class {label}, but the network has {} classes from 0; correct the data set",
                            self.class_weights.len()
                        )));
                    }
                };
                batch.classes.push(class);
                batch.weights.push(weight);
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
        Ok(MapCollator { pictures, size: self.size, class_weights: self.weights.clone() })
    }

    fn pipeline(&self) -> Result<Pipeline> {
        let [height, width] = self.size;
        let mut pipeline = Pipeline::default();
        if self.crop < 1.0 {
            let crop = RandomResizedCrop { width, height, min_area: self.crop, ..Default::default() };
            pipeline = pipeline.then(crop)?;
        }
        if self.flip > 0.0 {
            pipeline = pipeline.sometimes(self.flip, Flip::default())?;
        }
        if self.colour > 0.0 {
            let [brightness, contrast, saturation] = [self.colour; 3];
            pipeline = pipeline.then(Colour { brightness, contrast, saturation, hue: 0.3 * self.colour })?;
        }
        Ok(pipeline)
    }

    fn loss(&self, network: &BisenetNetwork, batch: &MappedPictures, device: &Device) -> Result<Loss> {
        let pictures = TensorData::new(batch.pictures.values().to_vec(), batch.pictures.shape());
        let scores = network.forward(Tensor::from_data(pictures, device));
        let (pixels, count) = (batch.classes.len(), self.classes.len());
        let scores = scores.swap_dims(1, 2).swap_dims(2, 3).reshape([pixels, count]);
        let classes = TensorData::new(batch.classes.clone(), [pixels, 1]);
        let weights = TensorData::new(batch.weights.clone(), [pixels, 1]);
        let likely = log_softmax(scores, 1).gather(1, Tensor::<2, Int>::from_data(classes, device));
        let counted = batch.weights.iter().sum::<f32>();
        let counted = if counted > 0.0 { counted } else { 1.0 };
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
