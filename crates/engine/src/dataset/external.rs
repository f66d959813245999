//! A data set on disk.

use std::path::{Path, PathBuf};

use crate::dataset::Dataset;

/// A data set on disk in a known format: `"coco"`, `"voc"`, `"imagenet"`, `"kitti"`, ...
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExternalDataset {
    path: PathBuf,
    dataset_type: String,
}

impl ExternalDataset {
    /// Creates a reference to the data set of format `dataset_type` at `path`.
    pub fn new(path: impl Into<PathBuf>, dataset_type: impl Into<String>) -> Self {
        Self { path: path.into(), dataset_type: dataset_type.into().to_lowercase() }
    }

    /// Returns its folder or file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns its format, in lower case.
    pub fn dataset_type(&self) -> &str {
        &self.dataset_type
    }
}

impl Dataset for ExternalDataset {}
