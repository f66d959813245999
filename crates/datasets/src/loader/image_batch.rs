//! Batches of pictures as a network takes them.

use std::sync::{Arc, Mutex, PoisonError, Weak};

use opendr_engine::dataset::Sample;
use opendr_engine::{Error, Result, Value};
use opendr_vision::{InputGeometry, Preprocess};

use crate::loader::Collate;

/// Makes [`ImageBatch`]es of samples whose first datum is a picture. The memory of batches that were dropped is used again.
pub struct ImageBatches {
    preprocess: Preprocess,
    free: Arc<Memories>,
}

/// Memories of batches that were dropped.
type Memories = Mutex<Vec<Vec<f32>>>;

/// Pictures as one tensor, and their targets.
pub struct ImageBatch {
    values: Vec<f32>,
    shape: [usize; 4],
    targets: Vec<Option<Value>>,
    geometries: Vec<InputGeometry>,
    home: Weak<Memories>,
}

impl ImageBatches {
    /// Batches of what `preprocess` makes of each picture.
    pub fn new(preprocess: Preprocess) -> Self {
        // The loader has its threads already.
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
                return Err(Error::invalid_input(
                    "a sample without a picture does not go into a batch of them",
                ));
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
    /// How many pictures there are.
    pub fn len(&self) -> usize {
        self.shape[0]
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// `[pictures, channels, height, width]`, or `[pictures, height, width, channels]`, as the preprocessing lays them.
    pub fn shape(&self) -> [usize; 4] {
        self.shape
    }

    /// The pictures, one after the other.
    pub fn values(&self) -> &[f32] {
        &self.values[..self.shape.iter().product()]
    }

    /// The target of each picture, in pixels of the augmented picture.
    pub fn targets(&self) -> &[Option<Value>] {
        &self.targets
    }

    /// Where each augmented picture lies in its part of the tensor.
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
