//! Samples that are kept once they were read.

use std::sync::OnceLock;

use crate::dataset::{Dataset, DatasetIterator, Sample, forward};
use crate::{Error, Result};

/// A data set whose samples are kept in memory once they were read; failures are not.
pub struct CachedDatasetIterator<D> {
    original: D,
    samples: Vec<OnceLock<Sample>>,
}

impl<D: DatasetIterator> CachedDatasetIterator<D> {
    /// Keeps the samples of `original`. They share their bulk with the copies that are handed out.
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
        let place = self
            .samples
            .get(index)
            .ok_or_else(|| Error::not_found(format!("there is no sample {index} among {count}")))?;
        if let Some(sample) = place.get() {
            return Ok(sample.clone());
        }
        let sample = self.original.get(index)?;
        Ok(place.get_or_init(|| sample).clone())
    }

    forward!(self, index => self.original, index);
}
