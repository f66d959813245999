//! A data set that caches its samples in memory.

use std::sync::OnceLock;

use crate::dataset::{Dataset, DatasetIterator, Sample, forward};
use crate::{Error, Result};

/// A data set that keeps its samples in memory after the first read; errors are not kept.
pub struct CachedDatasetIterator<D> {
    original: D,
    samples: Vec<OnceLock<Sample>>,
}

impl<D: DatasetIterator> CachedDatasetIterator<D> {
    /// Creates a cache of `original`. Returned samples share their payload with the cached ones.
    pub fn new(original: D) -> Self {
        let samples = (0..original.len()).map(|_| OnceLock::new()).collect();
        Self { original, samples }
    }
}

impl<D: DatasetIterator> Dataset for CachedDatasetIterator<D> {}

impl<D: DatasetIterator> DatasetIterator for CachedDatasetIterator<D> {
    fn len(&self) -> usize {
        self.samples.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let count = self.samples.len();
        let slot = self
            .samples
            .get(index)
            .ok_or_else(|| Error::not_found(format!("there is no sample {index} among {count}")))?;
        if let Some(sample) = slot.get() {
            return Ok(sample.clone());
        }
        let sample = self.original.get(index)?;
        Ok(slot.get_or_init(|| sample).clone())
    }

    forward!(self, index => self.original, index);
}
