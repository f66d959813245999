//! What comes of a trial.

use opendr_engine::{Error, Result};
use serde_json::Value;

use crate::Timestamp;
use crate::records::{INTERRUPTED, PAUSED_STATE, StudyRecord, TrialRecord, TrialState};
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
    /// Something other than the pruner wants it to end here for now, such as a user: it is the first to be asked for when
    /// the study goes on, with this state.
    Interrupted(Value),
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

/// The state from which the trial goes on.
pub(super) fn checkpoint(trial: &TrialRecord, state: Value) -> Operation {
    note(trial, PAUSED_STATE, state)
}

/// Lets a trial wait that has a state from which to go on.
pub(super) fn interrupt(trial: &TrialRecord) -> Vec<Operation> {
    vec![note(trial, INTERRUPTED, true.into()), wait(trial)]
}

/// What is noted of a trial when it is no longer interrupted.
pub(super) fn go_on(trial: &TrialRecord) -> Operation {
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
