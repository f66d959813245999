//! Contents of a checkpoint of a training.

use burn::module::Module;
use burn::optim::{ModuleOptimizer, OptimizerRecord};
use burn::store::{ModuleRecord, RecordError};
use burn::tensor::Bytes;
use opendr_engine::{Error, Result, ResultExt};
use opendr_runlog::Checkpoint;

use crate::training_state::TrainingState;

const NETWORK: &str = "network.bpk";
const AVERAGE: &str = "average.bpk";
const OPTIMIZER: &str = "optimizer.bpk";
const STATE: &str = "training_state.json";
/// File name of the state in checkpoints of version 1.
const FORMER_STATE: &str = "standing.json";

/// A loaded checkpoint.
pub struct Saved<'a> {
    checkpoint: &'a Checkpoint,
    /// Progress of the training.
    pub state: TrainingState,
}

impl<'a> Saved<'a> {
    /// Returns the files of a checkpoint.
    ///
    /// # Errors
    /// `Internal` when a part cannot be serialised.
    pub fn files<M: Module>(
        state: &TrainingState,
        network: M,
        average: Option<&M>,
        optimizer: &ModuleOptimizer,
    ) -> Result<Vec<(&'static str, Vec<u8>)>> {
        let mut files = vec![
            (STATE, TrainingState::FORMAT.to_pretty_json(state)?.into_bytes()),
            (NETWORK, bytes(network.into_record().into_bytes())?),
            (OPTIMIZER, bytes(optimizer.into_bytes())?),
        ];
        if let Some(average) = average {
            files.push((AVERAGE, bytes(average.clone().into_record().into_bytes())?));
        }
        Ok(files)
    }

    /// Reads the progress of the training.
    ///
    /// # Errors
    /// `NotFound` or `Format` when the checkpoint is not one of a training, `Unsupported` when it is of a newer OpenDR.
    pub fn read(checkpoint: &'a Checkpoint) -> Result<Self> {
        let former = checkpoint.names().find(|name| *name == FORMER_STATE);
        let json = checkpoint.file(former.unwrap_or(STATE))?;
        let state = TrainingState::FORMAT
            .read(&json)
            .context(|| format!("resuming from {}", checkpoint.path().display()))?;
        Ok(Self { checkpoint, state })
    }

    /// Returns `network` with the weights of the checkpoint.
    ///
    /// # Errors
    /// `Format` when the checkpoint is of another network.
    pub fn network_into<M: Module>(&self, network: M) -> Result<M> {
        self.module(NETWORK, network)
    }

    /// Returns `network` with the averaged weights of the checkpoint.
    ///
    /// # Errors
    /// As [`Saved::network_into`].
    pub fn average_into<M: Module>(&self, network: M) -> Result<M> {
        self.module(AVERAGE, network)
    }

    /// Returns `optimizer` with the state of the checkpoint.
    ///
    /// # Errors
    /// `Format` when the checkpoint is of another optimiser.
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
            "{name} of the checkpoint {} does not fit this network; resume with the parameters of the first run",
            self.checkpoint.path().display()
        ))
        .with_source(error)
    }
}

fn bytes(written: std::result::Result<Bytes, RecordError>) -> Result<Vec<u8>> {
    written.map(|bytes| bytes.to_vec()).map_err(|error| not_serialisable().with_source(error))
}

fn not_serialisable() -> Error {
    Error::internal("a checkpoint cannot be serialised")
}
