//! What a training is told by its learner.

use std::path::Path;

use burn::module::Module;
use burn::tensor::{Device, Tensor};
use opendr_datasets::augment::Pipeline;
use opendr_datasets::loader::Collate;
use opendr_engine::Result;
use opendr_engine::model::{Manifest, ModelWriter};

/// What a learner trains and by what it is judged; everything else of a training is the same for all.
pub trait Objective: Sync {
    /// The network.
    type Network: Module;
    /// What makes batches of samples, on the loader's threads: pre-processing, and targets as the loss wants them.
    type Collate: Collate;

    /// A collator.
    ///
    /// # Errors
    /// When a parameter does not fit.
    fn collate(&self) -> Result<Self::Collate>;

    /// How samples are augmented before; not at all by default.
    ///
    /// # Errors
    /// When a parameter does not fit.
    fn pipeline(&self) -> Result<Pipeline> {
        Ok(Pipeline::default())
    }

    /// The loss of a batch, the mean over its samples. While training, `device` records what is computed.
    ///
    /// # Errors
    /// When the batch does not fit the network.
    fn loss(
        &self,
        network: &Self::Network,
        batch: &<Self::Collate as Collate>::Batch,
        device: &Device,
    ) -> Result<Loss>;

    /// The trained network as a container for inference.
    ///
    /// # Errors
    /// When the network cannot be written as ONNX.
    fn container(&self, network: &Self::Network) -> Result<Container>;
}

/// The loss of a batch.
pub struct Loss {
    /// What is minimised, `[1]`.
    pub total: Tensor<1>,
    /// What it is made of, by name, each `[1]`; for the log.
    pub parts: Vec<(&'static str, Tensor<1>)>,
}

impl From<Tensor<1>> for Loss {
    fn from(total: Tensor<1>) -> Self {
        Self { total, parts: Vec::new() }
    }
}

/// A model container before it is written.
pub struct Container {
    /// Its manifest, without files.
    pub manifest: Manifest,
    /// Its files by name.
    pub files: Vec<(String, Vec<u8>)>,
}

impl Container {
    /// Writes it to `path`, whole or not at all.
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
