//! Data sets as arguments of `fit` and `eval`.

use crate::dataset::{DatasetIterator, ExternalDataset};

/// A data set as an argument of `fit` and `eval`.
#[derive(Clone, Copy)]
pub enum DatasetRef<'a> {
    /// A data set on disk, read by its format.
    External(&'a ExternalDataset),
    /// Samples from a program.
    Iterator(&'a dyn DatasetIterator),
}

impl<'a> From<&'a ExternalDataset> for DatasetRef<'a> {
    fn from(dataset: &'a ExternalDataset) -> Self {
        Self::External(dataset)
    }
}

impl<'a> From<&'a dyn DatasetIterator> for DatasetRef<'a> {
    fn from(dataset: &'a dyn DatasetIterator) -> Self {
        Self::Iterator(dataset)
    }
}
