//! Outcomes of trials.

use opendr_engine::{Error, Result};
use serde_json::Value;

use crate::Timestamp;
use crate::records::{INTERRUPTED, PAUSED_STATE, StudyRecord, TrialRecord, TrialState};
use crate::storage::{Notes, Operation};

/// System attribute with the reason of a failure.
const REASON: &str = "fail_reason";

/// Outcome of a trial.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// Values of the objective, one per direction. NaN fails the trial, as it cannot be compared.
    Complete(Vec<f64>),
    /// Stopped before its end; the last report counts as its value.
    Pruned,
    /// Paused at a rung, with the state from which it resumes, such as the path of a checkpoint:
    /// [`Trial::resumed_from`](crate::Trial::resumed_from) returns it.
    Paused(Value),
    /// Interrupted by something other than the pruner, such as a user. It is the first trial to be resumed when
    /// the study continues, with this state.
    Interrupted(Value),
    /// Failed, with the reason.
    Failed(String),
}

/// The value of an objective with one direction.
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
                    "trial {} has {} values, but the study has {} directions",
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
            Self::Paused(state) => Ok(vec![checkpoint(trial, state), wait(trial)]),
            Self::Interrupted(state) => {
                Ok([checkpoint(trial, state)].into_iter().chain(interrupt(trial)).collect())
            }
            Self::Failed(reason) => Ok(fail(trial, &reason)),
        }
    }
}

pub(super) fn fail(trial: &TrialRecord, reason: &str) -> Vec<Operation> {
    vec![note(trial, REASON, reason.into()), ended(trial, TrialState::Failed, Vec::new())]
}

/// Saves the state from which the trial resumes.
pub(super) fn checkpoint(trial: &TrialRecord, state: Value) -> Operation {
    note(trial, PAUSED_STATE, state)
}

/// Pauses a trial that has a saved state.
pub(super) fn interrupt(trial: &TrialRecord) -> Vec<Operation> {
    vec![note(trial, INTERRUPTED, true.into()), wait(trial)]
}

/// Marks a trial as no longer interrupted.
pub(super) fn resume(trial: &TrialRecord) -> Operation {
    note(trial, INTERRUPTED, false.into())
}

fn wait(trial: &TrialRecord) -> Operation {
    ended(trial, TrialState::Waiting, Vec::new())
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
