//! Contents of a checkpoint of a training.

use burn::optim::{ModuleOptimizer, OptimizerRecord};
use burn::store::{ModuleRecord, RecordError};
use burn::tensor::Bytes;
use opendr_engine::{Error, Result, ResultExt};
use opendr_runlog::{Checkpoint, Checkpoints};

use crate::payload::{number, truncated};
use crate::training_state::TrainingState;

/// File name of the network.
pub const NETWORK: &str = "network.bpk";
/// File name of the average.
pub const AVERAGE: &str = "average.bpk";
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

    /// Reads the weights of a file.
    ///
    /// # Errors
    /// `Format` when the file is damaged; `Io`.
    pub fn record(&self, name: &str) -> Result<ModuleRecord> {
        let bytes = Bytes::from_bytes_vec(self.checkpoint.file(name)?);
        ModuleRecord::from_bytes(bytes).map_err(|error| self.other(name, error))
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

    /// Returns the error of a file that does not fit.
    #[cold]
    pub fn other(&self, name: &str, error: RecordError) -> Error {
        Error::format(format!(
            "{name} of the checkpoint {} does not fit this network; resume with the parameters of the first run",
            self.checkpoint.path().display()
        ))
        .with_source(error)
    }
}

/// Returns the bytes of weights.
///
/// # Errors
/// `Internal` when they cannot be serialised.
pub fn network_bytes(record: ModuleRecord) -> Result<Vec<u8>> {
    record.into_bytes().map(|bytes| bytes.to_vec()).map_err(not_serialisable)
}

/// Returns the files of progress and optimiser.
///
/// # Errors
/// `Internal` when one cannot be serialised.
pub fn state_files(
    state: &TrainingState,
    optimizer: &ModuleOptimizer,
) -> Result<[(&'static str, Vec<u8>); 2]> {
    let optimizer = optimizer.into_bytes().map_err(not_serialisable)?;
    Ok([(STATE, TrainingState::FORMAT.to_pretty_json(state)?.into_bytes()), (OPTIMIZER, optimizer.to_vec())])
}

/// Returns the files of a checkpoint as bytes for another process.
///
/// # Errors
/// `Io` when a file cannot be read.
pub fn checkpoint_bytes(checkpoint: &Checkpoint) -> Result<Vec<u8>> {
    let mut bytes = checkpoint.step.to_le_bytes().to_vec();
    for name in checkpoint.names() {
        let content = checkpoint.file(name)?;
        bytes.extend((name.len() as u64).to_le_bytes());
        bytes.extend(name.as_bytes());
        bytes.extend((content.len() as u64).to_le_bytes());
        bytes.extend(content);
    }
    Ok(bytes)
}

/// Saves the checkpoint of another process among `checkpoints`.
///
/// # Errors
/// `Format` for bytes that are not those of [`checkpoint_bytes`]; `Io`.
pub fn save_checkpoint(checkpoints: &Checkpoints, mut bytes: &[u8]) -> Result<()> {
    let step = number(&mut bytes)?;
    let mut files = Vec::new();
    while !bytes.is_empty() {
        let name = std::str::from_utf8(part(&mut bytes)?).map_err(|error| truncated().with_source(error))?;
        files.push((name, part(&mut bytes)?));
    }
    checkpoints.save(step, &files).map(drop)
}

/// Takes a number of bytes and as many bytes.
fn part<'a>(bytes: &mut &'a [u8]) -> Result<&'a [u8]> {
    let length = usize::try_from(number(bytes)?).map_err(|_| truncated())?;
    let (part, rest) = bytes.split_at_checked(length).ok_or_else(truncated)?;
    *bytes = rest;
    Ok(part)
}

fn not_serialisable(error: RecordError) -> Error {
    Error::internal("a checkpoint cannot be serialised").with_source(error)
}
