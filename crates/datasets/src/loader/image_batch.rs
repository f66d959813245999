//! Batches of images as network inputs.

use std::sync::{Arc, Mutex, PoisonError, Weak};

use opendr_engine::dataset::Sample;
use opendr_engine::{Error, Result, Value};
use opendr_vision::{InputGeometry, Preprocess};

use crate::loader::Collate;

/// Collates samples whose first datum is an image into [`ImageBatch`]es, with reuse of the memory of dropped
/// batches.
pub struct ImageBatches {
    preprocess: Preprocess,
    free: Arc<Memories>,
}

/// Memory of dropped batches.
type Memories = Mutex<Vec<Vec<f32>>>;

/// Images as one tensor, with their targets.
pub struct ImageBatch {
    values: Vec<f32>,
    shape: [usize; 4],
    targets: Vec<Option<Value>>,
    geometries: Vec<InputGeometry>,
    home: Weak<Memories>,
}

impl ImageBatches {
    /// Creates batches of images processed by `preprocess`.
    pub fn new(preprocess: Preprocess) -> Self {
        // The loader already uses several threads.
        Self { preprocess: preprocess.threads(1), free: Arc::default() }
    }
}

impl Collate for ImageBatches {
    type Batch = ImageBatch;

    fn start(&self, capacity: usize) -> ImageBatch {
        let mut values = self.free.lock().unwrap_or_else(PoisonError::into_inner).pop().unwrap_or_default();
        values.resize(capacity * self.preprocess.len(), 0.0);
        let [_, rest @ ..] = self.preprocess.shape();
        ImageBatch {
            values,
            shape: [0, rest[0], rest[1], rest[2]],
            targets: Vec::with_capacity(capacity),
            geometries: Vec::with_capacity(capacity),
            home: Arc::downgrade(&self.free),
        }
    }

    fn add(&self, batch: &mut ImageBatch, sample: Sample) -> Result<()> {
        let image = match sample.data.first() {
            Some(Value::Image(image)) => image,
            Some(Value::ImageWithDetections(both)) => &both.image,
            _ => {
                return Err(Error::invalid_input("the sample has no image, which batches of images need"));
            }
        };
        let at = batch.len() * self.preprocess.len();
        let place = batch.values.get_mut(at..at + self.preprocess.len());
        let place = place.ok_or_else(|| Error::internal("a batch has less room than samples"))?;
        batch.geometries.push(self.preprocess.run_into(image.view(), place)?);
        batch.targets.push(sample.target);
        batch.shape[0] += 1;
        Ok(())
    }
}

impl ImageBatch {
    /// Returns the number of images.
    pub fn len(&self) -> usize {
        self.shape[0]
    }

    /// Returns whether there are no images.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the shape: `[images, channels, height, width]`, or `[images, height, width, channels]`, by the
    /// layout of the preprocessing.
    pub fn shape(&self) -> [usize; 4] {
        self.shape
    }

    /// Returns the values of the images, one image after the other.
    pub fn values(&self) -> &[f32] {
        &self.values[..self.shape.iter().product()]
    }

    /// Returns the target of each image, in pixels of the augmented image.
    pub fn targets(&self) -> &[Option<Value>] {
        &self.targets
    }

    /// Returns the location of each augmented image in its part of the tensor.
    pub fn geometries(&self) -> &[InputGeometry] {
        &self.geometries
    }
}

impl Drop for ImageBatch {
    fn drop(&mut self) {
        if let Some(home) = self.home.upgrade() {
            let values = std::mem::take(&mut self.values);
            home.lock().unwrap_or_else(PoisonError::into_inner).push(values);
        }
    }
}
