//! Training objective of a learner.

use std::path::Path;

use burn::module::Module;
use burn::tensor::{Device, Tensor};
use opendr_datasets::augment::Pipeline;
use opendr_datasets::loader::Collate;
use opendr_engine::Result;
use opendr_engine::model::{Manifest, ModelWriter};

/// Training objective of a learner: network, batches, loss and container. All other parts of a training are shared.
pub trait Objective: Sync {
    /// The network.
    type Network: Module;
    /// Collator of samples to batches, on the loader's threads: preprocessing, and targets in the form of the loss.
    type Collate: Collate;

    /// Returns a collator.
    ///
    /// # Errors
    /// When a parameter is invalid.
    fn collate(&self) -> Result<Self::Collate>;

    /// Returns the augmentation of samples before collation; none by default.
    ///
    /// # Errors
    /// When a parameter is invalid.
    fn pipeline(&self) -> Result<Pipeline> {
        Ok(Pipeline::default())
    }

    /// Returns the loss of a batch, the mean over its samples. In training, `device` records the operations.
    ///
    /// # Errors
    /// When the batch does not fit the network.
    fn loss(
        &self,
        network: &Self::Network,
        batch: &<Self::Collate as Collate>::Batch,
        device: &Device,
    ) -> Result<Loss>;

    /// Returns the container of the trained network for inference.
    ///
    /// # Errors
    /// When the network cannot be exported to ONNX.
    fn container(&self, network: &Self::Network) -> Result<Container>;
}

/// The loss of a batch.
pub struct Loss {
    /// Total loss, which is minimised, `[1]`.
    pub total: Tensor<1>,
    /// Parts of the loss by name, each `[1]`; for the log.
    pub parts: Vec<(&'static str, Tensor<1>)>,
}

impl From<Tensor<1>> for Loss {
    fn from(total: Tensor<1>) -> Self {
        Self { total, parts: Vec::new() }
    }
}

/// A model container in memory.
pub struct Container {
    /// The manifest, without files.
    pub manifest: Manifest,
    /// Files by name.
    pub files: Vec<(String, Vec<u8>)>,
}

impl Container {
    /// Writes the container to `path` atomically.
    ///
    /// # Errors
    /// As [`ModelWriter`].
    pub fn write(&self, path: &Path) -> Result<()> {
        let mut writer = ModelWriter::new(path, self.manifest.clone())?;
        for (name, bytes) in &self.files {
            writer.add(name, bytes)?;
        }
        writer.finish().map(drop)
    }
}
