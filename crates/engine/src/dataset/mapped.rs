//! Samples that pass through a function.

use crate::Result;
use crate::dataset::{Dataset, DatasetIterator, Sample, forward};

/// A data set whose samples pass through a function when they are read (OpenDR's `MappedDatasetIterator`).
pub struct MappedDatasetIterator<D, F> {
    original: D,
    map_function: F,
}

impl<D: DatasetIterator, F: Fn(Sample) -> Result<Sample> + Send + Sync> MappedDatasetIterator<D, F> {
    /// `map_function` over the samples of `original`.
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

    // Not its files and sizes: they are of what the function was given.
    forward!(names self, index => self.original, index);
}
