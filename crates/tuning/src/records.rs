//! What is known of studies and their trials.

use std::collections::BTreeMap;

use opendr_engine::params::{ParamMap, ParamValue};
use opendr_engine::{Error, Result};
use serde_json::Value;

use crate::{Distribution, Timestamp};

/// What of the objective is good.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Direction {
    /// Small values.
    Minimize,
    /// Large values.
    Maximize,
}

impl Direction {
    /// The value with the sign with which less is better; NaN counts as the worst.
    pub(crate) fn loss(self, value: f64) -> f64 {
        match self {
            _ if value.is_nan() => f64::INFINITY,
            Self::Minimize => value,
            Self::Maximize => -value,
        }
    }
}

/// Where a trial stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TrialState {
    /// A worker is at it.
    Running,
    /// It has its values.
    Complete,
    /// It was not worth going on.
    Pruned,
    /// It raised an error, or its worker died.
    Failed,
    /// Nobody is at it: it was put into the queue, or it is paused at a rung and can be gone on with.
    Waiting,
}

impl TrialState {
    /// Whether nothing about the trial can change any more.
    pub fn is_finished(self) -> bool {
        matches!(self, Self::Complete | Self::Pruned | Self::Failed)
    }
}

/// A parameter of a trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Suggestion {
    /// What it might have been.
    pub distribution: Distribution,
    /// What it is, as [`Distribution::value_from_number`] understands it.
    pub number: f64,
}

impl Suggestion {
    /// What it is.
    pub fn value(&self) -> Value {
        self.distribution.value_from_number(self.number).unwrap_or_default()
    }
}

/// One trial.
#[derive(Debug, Clone, PartialEq)]
pub struct TrialRecord {
    /// Its number in the study, from 0.
    pub number: usize,
    /// Where it stands.
    pub state: TrialState,
    /// Its parameters by name.
    pub params: BTreeMap<String, Suggestion>,
    /// What the objective is, one value for each direction of the study; empty until it is complete. A pruned trial may
    /// have one.
    pub values: Vec<f64>,
    /// What was measured on the way, by step.
    pub reports: BTreeMap<i64, f64>,
    /// What users noted.
    pub user_attributes: BTreeMap<String, Value>,
    /// What samplers, pruners and the tuner noted.
    pub system_attributes: BTreeMap<String, Value>,
    /// When it began.
    pub started: Option<Timestamp>,
    /// When it ended.
    pub ended: Option<Timestamp>,
    /// The number by which the storage knows it.
    pub(crate) id: usize,
    /// Who is, or was, at it.
    pub(crate) worker: String,
}

/// The system attribute with the state from which a paused trial goes on.
pub(crate) const PAUSED_STATE: &str = "opendr:paused_state";
/// The system attribute that says whether it was not the pruner that paused a trial.
pub(crate) const INTERRUPTED: &str = "opendr:interrupted";

impl TrialRecord {
    /// The only value of the objective, when there is exactly one.
    pub fn value(&self) -> Option<f64> {
        match self.values.as_slice() {
            [value] => Some(*value),
            _ => None,
        }
    }

    /// The last step at which something was reported, and that.
    pub fn last_report(&self) -> Option<(i64, f64)> {
        self.reports.last_key_value().map(|(step, value)| (*step, *value))
    }

    /// Whether it stands at a rung and can be gone on with.
    pub fn is_paused(&self) -> bool {
        self.state == TrialState::Waiting && self.system_attributes.contains_key(PAUSED_STATE)
    }

    /// Whether it was interrupted, by a user or by the death of its worker, and is to go on before anything else.
    pub fn is_interrupted(&self) -> bool {
        self.is_paused() && self.system_attributes.get(INTERRUPTED) == Some(&Value::Bool(true))
    }

    /// The parameters as learners take them.
    ///
    /// # Errors
    /// `InvalidParam` for a choice that is a JSON object, which no learner takes.
    pub fn param_map(&self) -> Result<ParamMap> {
        let value = |(name, suggestion): (&String, &Suggestion)| {
            let value: ParamValue = serde_json::from_value(suggestion.value()).map_err(|error| {
                Error::invalid_param(format!("{name}: no learner takes {}", suggestion.value()))
                    .with_source(error)
            })?;
            Ok((name.clone(), value))
        };
        self.params.iter().map(value).collect()
    }
}

/// One study.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyRecord {
    /// Its name, which no other study of the storage has.
    pub name: String,
    /// What is good of each value of the objective.
    pub directions: Vec<Direction>,
    /// Its trials; the number is the place.
    pub trials: Vec<TrialRecord>,
    /// What users noted.
    pub user_attributes: BTreeMap<String, Value>,
    /// What samplers, pruners and the tuner noted.
    pub system_attributes: BTreeMap<String, Value>,
}

impl StudyRecord {
    /// What of the first value is good.
    pub fn direction(&self) -> Direction {
        self.directions.first().copied().unwrap_or(Direction::Minimize)
    }

    /// The complete trial with the best value; of equals the first. `None` without one, or with several directions.
    pub fn best(&self) -> Option<&TrialRecord> {
        let [direction] = self.directions[..] else { return None };
        let loss = |trial: &TrialRecord| trial.value().map_or(f64::INFINITY, |value| direction.loss(value));
        self.complete().min_by(|a, b| loss(a).total_cmp(&loss(b)))
    }

    /// The complete trials than which no other is better in one direction and as good in all.
    pub fn pareto_front(&self) -> Vec<&TrialRecord> {
        let complete: Vec<_> = self.complete().collect();
        let losses: Vec<_> = complete.iter().map(|trial| self.losses(trial)).collect();
        let undominated = |at: &usize| !losses.iter().any(|other| dominates(other, &losses[*at]));
        (0..complete.len()).filter(undominated).map(|at| complete[at]).collect()
    }

    /// The complete trials.
    pub fn complete(&self) -> impl Iterator<Item = &TrialRecord> {
        self.trials.iter().filter(|trial| trial.state == TrialState::Complete)
    }

    /// The values of a trial with the signs with which less is better.
    pub(crate) fn losses(&self, trial: &TrialRecord) -> Vec<f64> {
        self.directions.iter().zip(&trial.values).map(|(direction, value)| direction.loss(*value)).collect()
    }
}

/// Whether losses `a` are nowhere larger than `b` and somewhere smaller.
pub(crate) fn dominates(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a <= b) && a.iter().zip(b).any(|(a, b)| a < b)
}
