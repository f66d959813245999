//! The evaluations during the training of a policy.

use std::cmp::Ordering;

use opendr_engine::{Error, JsonFormat, Result, ResultExt as _};
use opendr_runlog::Checkpoint;
use serde::{Deserialize, Serialize};

/// File name in a checkpoint.
pub const EVALUATIONS: &str = "evaluations.json";
/// File name in checkpoints of version 1, a list of triples.
const FORMER: &str = "measured.json";

/// Result of one evaluation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "Row", into = "Row")]
pub struct EvaluationRecord {
    /// Time steps of the training.
    pub timesteps: u64,
    /// Mean return of the episodes.
    pub mean_return: f64,
    /// Fraction of the episodes that ended with success, if the environment reports it.
    pub success_rate: Option<f64>,
}

/// A record as it is serialised.
type Row = (u64, f64, Option<f64>);

impl From<Row> for EvaluationRecord {
    fn from((timesteps, mean_return, success_rate): Row) -> Self {
        Self { timesteps, mean_return, success_rate }
    }
}

impl From<EvaluationRecord> for Row {
    fn from(record: EvaluationRecord) -> Self {
        (record.timesteps, record.mean_return, record.success_rate)
    }
}

/// Results of all evaluations, oldest first.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct EvaluationHistory {
    /// The results.
    pub evaluations: Vec<EvaluationRecord>,
}

impl EvaluationHistory {
    /// Format of the file in a checkpoint. Version 2 is an object instead of a list.
    pub const FORMAT: JsonFormat = JsonFormat::new("list of evaluations", 2);

    /// Reads the evaluations of a checkpoint of this version or an earlier one.
    ///
    /// # Errors
    /// `NotFound`, `Integrity` or `Format` for an incomplete or damaged checkpoint, `Unsupported` for one of a newer OpenDR.
    pub fn from_checkpoint(checkpoint: &Checkpoint) -> Result<Self> {
        let context = || format!("resuming from {}", checkpoint.path().display());
        if checkpoint.names().any(|name| name == FORMER) {
            let json = checkpoint.file(FORMER)?;
            let evaluations = serde_json::from_slice(&json).map_err(|error| {
                Error::format(format!("{FORMER} is not a list of evaluations")).with_source(error)
            });
            return evaluations.map(|evaluations| Self { evaluations }).context(context);
        }
        Self::FORMAT.read(&checkpoint.file(EVALUATIONS)?).context(context)
    }

    /// Returns whether the last evaluation was at this time step.
    pub fn ends_at(&self, timesteps: u64) -> bool {
        self.evaluations.last().is_some_and(|record| record.timesteps == timesteps)
    }

    /// Returns the evaluation of the highest success rate, then of the highest return; the last of equals.
    pub fn best(&self) -> Option<&EvaluationRecord> {
        let score = |record: &EvaluationRecord| (record.success_rate.unwrap_or(0.0), record.mean_return);
        let order =
            |one: &&EvaluationRecord, other: &&EvaluationRecord| score(one).partial_cmp(&score(other));
        self.evaluations.iter().max_by(|one, other| order(one, other).unwrap_or(Ordering::Equal))
    }
}
