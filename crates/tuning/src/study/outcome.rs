//! What comes of a trial.

use opendr_engine::{Error, Result};
use serde_json::Value;

use crate::Timestamp;
use crate::records::{PAUSED_STATE, StudyRecord, TrialRecord, TrialState};
use crate::storage::{Notes, Operation};
use crate::study::REASON;

/// What came of a trial.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// The values of the objective, one for each direction. NaN fails the trial: nothing is better or worse than it.
    Complete(Vec<f64>),
    /// It was stopped before its end; the last report stands for its value.
    Pruned,
    /// It stands at a rung. The value is all it takes to go on, such as the path of a checkpoint:
    /// [`Trial::resumed_from`](crate::Trial::resumed_from) gives it back.
    Paused(Value),
    /// It could not be carried out, for this reason.
    Failed(String),
}

/// The only value of an objective.
impl From<f64> for Outcome {
    fn from(value: f64) -> Self {
        Self::Complete(vec![value])
    }
}

impl Outcome {
    pub(super) fn operations(self, study: &StudyRecord, trial: &TrialRecord) -> Result<Vec<Operation>> {
        match self {
            Self::Complete(values) if values.len() != study.directions.len() => {
                Err(Error::invalid_param(format!(
                    "trial {} has {} values, but the study {} directions",
                    trial.number,
                    values.len(),
                    study.directions.len()
                )))
            }
            Self::Complete(values) if values.iter().any(|value| value.is_nan()) => {
                Ok(fail(trial, "the objective was not a number"))
            }
            Self::Complete(values) => Ok(vec![ended(trial, TrialState::Complete, values)]),
            Self::Pruned => Ok(prune(study, trial)),
            Self::Paused(state) => {
                Ok(vec![note(trial, PAUSED_STATE, state), ended(trial, TrialState::Waiting, Vec::new())])
            }
            Self::Failed(reason) => Ok(fail(trial, &reason)),
        }
    }
}

pub(super) fn fail(trial: &TrialRecord, reason: &str) -> Vec<Operation> {
    vec![note(trial, REASON, reason.into()), ended(trial, TrialState::Failed, Vec::new())]
}

pub(super) fn prune(study: &StudyRecord, trial: &TrialRecord) -> Vec<Operation> {
    let last = trial.last_report().filter(|(_, value)| study.directions.len() == 1 && !value.is_nan());
    vec![ended(trial, TrialState::Pruned, last.map(|(_, value)| value).into_iter().collect())]
}

fn ended(trial: &TrialRecord, state: TrialState, values: Vec<f64>) -> Operation {
    Operation::SetState { trial: trial.id, state, values, at: Timestamp::now() }
}

fn note(trial: &TrialRecord, key: &str, value: Value) -> Operation {
    Operation::NoteOfTrial { trial: trial.id, notes: Notes::System, key: key.to_owned(), value }
}
