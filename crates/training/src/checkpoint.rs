//! What a checkpoint of a training is made of.

use burn::module::Module;
use burn::optim::{ModuleOptimizer, OptimizerRecord};
use burn::store::{ModuleRecord, RecordError};
use burn::tensor::Bytes;
use opendr_engine::{Error, Result};
use opendr_runlog::Checkpoint;

use crate::standing::Standing;

const NETWORK: &str = "network.bpk";
const AVERAGE: &str = "average.bpk";
const OPTIMIZER: &str = "optimizer.bpk";
const STANDING: &str = "standing.json";

/// A checkpoint that was read.
pub struct Saved<'a> {
    checkpoint: &'a Checkpoint,
    /// How far the training had come.
    pub standing: Standing,
}

impl<'a> Saved<'a> {
    /// The files of a checkpoint.
    ///
    /// # Errors
    /// `Internal` when something has no form on disk.
    pub fn files<M: Module>(
        standing: &Standing,
        network: M,
        average: Option<&M>,
        optimizer: &ModuleOptimizer,
    ) -> Result<Vec<(&'static str, Vec<u8>)>> {
        let mut files = vec![
            (STANDING, serde_json::to_vec_pretty(standing).map_err(|error| unwritable().with_source(error))?),
            (NETWORK, bytes(network.into_record().into_bytes())?),
            (OPTIMIZER, bytes(optimizer.into_bytes())?),
        ];
        if let Some(average) = average {
            files.push((AVERAGE, bytes(average.clone().into_record().into_bytes())?));
        }
        Ok(files)
    }

    /// Reads how far the training had come.
    ///
    /// # Errors
    /// `Format` when it is no checkpoint of a training.
    pub fn read(checkpoint: &'a Checkpoint) -> Result<Self> {
        let json = checkpoint.file(STANDING)?;
        let standing = serde_json::from_slice(&json).map_err(|error| {
            Error::format(format!("{} is no checkpoint of a training", checkpoint.path().display()))
                .with_source(error)
        })?;
        Ok(Self { checkpoint, standing })
    }

    /// `network` with the weights that it had.
    ///
    /// # Errors
    /// `Format` when the checkpoint is of another network.
    pub fn network_into<M: Module>(&self, network: M) -> Result<M> {
        self.module(NETWORK, network)
    }

    /// `network` with the averaged weights.
    ///
    /// # Errors
    /// As [`Saved::network_into`].
    pub fn average_into<M: Module>(&self, network: M) -> Result<M> {
        self.module(AVERAGE, network)
    }

    /// `optimizer` with what it remembered.
    ///
    /// # Errors
    /// `Format` when the checkpoint is of another.
    pub fn optimizer_into(&self, optimizer: ModuleOptimizer) -> Result<ModuleOptimizer> {
        let bytes = Bytes::from_bytes_vec(self.checkpoint.file(OPTIMIZER)?);
        let record = OptimizerRecord::from_bytes(bytes).map_err(|error| self.other(OPTIMIZER, error))?;
        Ok(optimizer.load_record(record))
    }

    fn module<M: Module>(&self, name: &str, module: M) -> Result<M> {
        let bytes = Bytes::from_bytes_vec(self.checkpoint.file(name)?);
        let record = ModuleRecord::from_bytes(bytes).map_err(|error| self.other(name, error))?;
        module.try_load_record(record).map_err(|error| self.other(name, error))
    }

    fn other(&self, name: &str, error: RecordError) -> Error {
        Error::format(format!(
            "{name} of the checkpoint {} does not fit this network; resume with the parameters it was begun with",
            self.checkpoint.path().display()
        ))
        .with_source(error)
    }
}

fn bytes(written: std::result::Result<Bytes, RecordError>) -> Result<Vec<u8>> {
    written.map(|bytes| bytes.to_vec()).map_err(|error| unwritable().with_source(error))
}

fn unwritable() -> Error {
    Error::internal("a checkpoint has no form on disk")
}
