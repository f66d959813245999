//! Batches for YOLOX: images and their objects.

use opendr_datasets::loader::{Collate, ImageBatch, ImageBatches};
use opendr_engine::dataset::Sample;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, Value};
use opendr_vision::Preprocess;

use super::for_yolox;
use crate::object_detection_2d::ground_truth::GroundTruth;

/// Collates images with boxes.
pub struct Batches {
    images: ImageBatches,
    classes: Classes,
    min_score: f32,
}

/// A batch.
pub struct Batch {
    pub images: ImageBatch,
    /// The boxes of each image.
    pub truth: Vec<GroundTruth>,
}

impl Batches {
    /// Creates a collator for images of `side` x `side` pixels. Boxes below `min_score` are neither object nor background.
    pub fn new(side: usize, classes: Classes, min_score: f32) -> Self {
        Self { images: ImageBatches::new(for_yolox(Preprocess::new(side, side))), classes, min_score }
    }
}

impl Collate for Batches {
    type Batch = Batch;

    fn start(&self, capacity: usize) -> Batch {
        Batch { images: self.images.start(capacity), truth: Vec::with_capacity(capacity) }
    }

    fn add(&self, batch: &mut Batch, mut sample: Sample) -> Result<()> {
        let Some(Value::BoundingBoxList(list)) = sample.target.take() else {
            return Err(Error::invalid_input(
                "the sample has no boxes; YOLOX trains on images with BoundingBoxList targets",
            ));
        };
        self.images.add(&mut batch.images, sample)?;
        let geometry = batch.images.geometries().last();
        batch.truth.extend(
            geometry.map(|geometry| GroundTruth::new(&list, &self.classes, self.min_score, geometry)),
        );
        Ok(())
    }
}
