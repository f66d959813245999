//! A data set with a function applied to its samples.

use crate::Result;
use crate::dataset::{Dataset, DatasetIterator, Sample, forward};

/// A data set that applies a function to each sample when it is read (OpenDR's `MappedDatasetIterator`).
pub struct MappedDatasetIterator<D, F> {
    original: D,
    map_function: F,
}

impl<D: DatasetIterator, F: Fn(Sample) -> Result<Sample> + Send + Sync> MappedDatasetIterator<D, F> {
    /// Creates a data set of the samples of `original` after `map_function`.
    pub fn new(original: D, map_function: F) -> Self {
        Self { original, map_function }
    }
}

impl<D: DatasetIterator, F: Fn(Sample) -> Result<Sample> + Send + Sync> Dataset
    for MappedDatasetIterator<D, F>
{
}

impl<D: DatasetIterator, F: Fn(Sample) -> Result<Sample> + Send + Sync> DatasetIterator
    for MappedDatasetIterator<D, F>
{
    fn len(&self) -> usize {
        self.original.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        (self.map_function)(self.original.get(index)?)
    }

    // Paths and image sizes are not forwarded: they describe the samples before the function.
    forward!(names self, index => self.original, index);
}
