//! Batches of images with classes.

use burn::nn::loss::{CrossEntropyLoss, CrossEntropyLossConfig};
use burn::tensor::{Device, Int, Tensor, TensorData};
use opendr_datasets::loader::{Collate, ImageBatch, ImageBatches};
use opendr_engine::Result;
use opendr_engine::dataset::Sample;
use opendr_perception_common::labelled::class_of;
use opendr_vision::Preprocess;

/// Collates [`LabelledPictures`].
pub struct PictureCollator {
    pictures: ImageBatches,
    classes: usize,
}

/// Batch of images and their class indices.
pub struct LabelledPictures {
    pictures: ImageBatch,
    classes: Vec<i64>,
}

impl PictureCollator {
    /// Creates a collator of images preprocessed by `preprocess`, with classes below `classes`.
    pub fn new(preprocess: Preprocess, classes: usize) -> Self {
        Self { pictures: ImageBatches::new(preprocess), classes }
    }
}

impl Collate for PictureCollator {
    type Batch = LabelledPictures;

    fn start(&self, capacity: usize) -> LabelledPictures {
        LabelledPictures { pictures: self.pictures.start(capacity), classes: Vec::with_capacity(capacity) }
    }

    fn add(&self, batch: &mut LabelledPictures, sample: Sample) -> Result<()> {
        let class = class_of(&sample, self.classes)?;
        self.pictures.add(&mut batch.pictures, sample)?;
        batch.classes.push(class);
        Ok(())
    }
}

impl LabelledPictures {
    /// Returns the images `[batch, 3, height, width]`.
    pub fn pictures(&self, device: &Device) -> Tensor<4> {
        Tensor::from_data(TensorData::new(self.pictures.values().to_vec(), self.pictures.shape()), device)
    }

    /// Returns the mean cross-entropy of logits `[batch, classes]`, with `smoothing` of the probability spread over all
    /// classes.
    pub fn cross_entropy(&self, logits: Tensor<2>, smoothing: f64, device: &Device) -> Tensor<1> {
        let classes = TensorData::new(self.classes.clone(), [self.classes.len()]);
        let loss: CrossEntropyLoss = CrossEntropyLossConfig::new()
            .with_smoothing((smoothing > 0.0).then_some(smoothing as f32))
            .init(device);
        loss.forward(logits, Tensor::<1, Int>::from_data(classes, device))
    }
}
