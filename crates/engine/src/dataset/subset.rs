//! Some samples of a data set, in an order of their own.

use crate::dataset::{Dataset, DatasetIterator, Sample, forward};
use crate::{Error, Result, Value};

/// Some samples of a data set, in an order of their own.
pub struct Subset<D> {
    original: D,
    indices: Vec<usize>,
}

impl<D: DatasetIterator> Subset<D> {
    /// The samples of `original` that `indices` name, in that order.
    ///
    /// # Errors
    /// `InvalidInput` for an index past the end.
    pub fn new(original: D, indices: Vec<usize>) -> Result<Self> {
        let count = original.len();
        match indices.iter().find(|index| **index >= count) {
            Some(index) => Err(Error::invalid_input(format!("there is no sample {index} among {count}"))),
            None => Ok(Self { original, indices }),
        }
    }

    /// The first `count` samples, or all where there are fewer.
    pub fn first(original: D, count: usize) -> Self {
        let indices = (0..original.len().min(count)).collect();
        Self { original, indices }
    }

    /// The numbers of the samples in the data set that they are of.
    pub fn indices(&self) -> &[usize] {
        &self.indices
    }

    fn at(&self, index: usize) -> Result<usize> {
        let count = self.indices.len();
        let missing = || Error::not_found(format!("there is no sample {index} among {count}"));
        self.indices.get(index).copied().ok_or_else(missing)
    }

    /// The number there, or one past the end of whatever the data set has.
    fn at_or_none(&self, index: usize) -> usize {
        self.indices.get(index).copied().unwrap_or(usize::MAX)
    }
}

impl<D: DatasetIterator> Dataset for Subset<D> {}

impl<D: DatasetIterator> DatasetIterator for Subset<D> {
    fn len(&self) -> usize {
        self.indices.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        self.original.get(self.at(index)?)
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        self.original.target(self.at(index)?)
    }

    forward!(self, index => self.original, self.at_or_none(index));
}
