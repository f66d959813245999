//! What learners train on and are measured by.

use std::path::{Path, PathBuf};

use crate::{Result, Value};

/// Any data set.
pub trait Dataset: Send + Sync {}

/// A datum with its annotation.
#[derive(Debug, Clone)]
pub struct Sample {
    /// What the learner is given; several for a learner with several ports, in the order of the ports.
    pub data: Vec<Value>,
    /// What it should answer.
    pub target: Option<Value>,
}

/// A data set whose samples can be had one by one.
pub trait DatasetIterator: Dataset {
    /// How many samples there are.
    fn len(&self) -> usize;

    /// Whether there is none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Sample number `index`.
    ///
    /// # Errors
    /// `NotFound` past the end; `Format` or `Io` for a sample that cannot be read.
    fn get(&self, index: usize) -> Result<Sample>;
}

/// A data set on disk in a known format: `"coco"`, `"voc"`, `"imagenet"`, `"kitti"`, ...
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExternalDataset {
    path: PathBuf,
    dataset_type: String,
}

impl ExternalDataset {
    /// The data set of format `dataset_type` at `path`.
    pub fn new(path: impl Into<PathBuf>, dataset_type: impl Into<String>) -> Self {
        Self { path: path.into(), dataset_type: dataset_type.into().to_lowercase() }
    }

    /// Its folder or file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its format, in lower case.
    pub fn dataset_type(&self) -> &str {
        &self.dataset_type
    }
}

impl Dataset for ExternalDataset {}

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
}

/// A data set as `fit` and `eval` take it.
#[derive(Clone, Copy)]
pub enum DatasetRef<'a> {
    /// On disk, to be read by its format.
    External(&'a ExternalDataset),
    /// Samples made by a program.
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
