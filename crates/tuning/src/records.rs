//! Records of studies and trials.

use std::collections::BTreeMap;

use opendr_engine::params::{ParamMap, ParamValue};
use opendr_engine::{Error, Result};
use serde_json::Value;

use crate::{Distribution, Timestamp};

/// Direction of optimisation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Direction {
    /// Smaller values are better.
    Minimize,
    /// Larger values are better.
    Maximize,
}

impl Direction {
    /// Returns the value with a sign such that less is better; NaN counts as the worst.
    pub(crate) fn loss(self, value: f64) -> f64 {
        match self {
            _ if value.is_nan() => f64::INFINITY,
            Self::Minimize => value,
            Self::Maximize => -value,
        }
    }
}

/// State of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TrialState {
    /// A worker is running it.
    Running,
    /// It has its values.
    Complete,
    /// A pruner stopped it.
    Pruned,
    /// It returned an error, or its worker died.
    Failed,
    /// No worker is running it: it is in the queue, or paused and can be resumed.
    Waiting,
}

impl TrialState {
    /// Returns whether the trial is final.
    pub fn is_finished(self) -> bool {
        matches!(self, Self::Complete | Self::Pruned | Self::Failed)
    }
}

/// A parameter of a trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Suggestion {
    /// Distribution of the parameter.
    pub distribution: Distribution,
    /// Number of the value, for [`Distribution::value_from_number`].
    pub number: f64,
}

impl Suggestion {
    /// Returns the value.
    pub fn value(&self) -> Value {
        self.distribution.value_from_number(self.number).unwrap_or_default()
    }
}

/// Record of a trial.
#[derive(Debug, Clone, PartialEq)]
pub struct TrialRecord {
    /// Number in the study, from 0.
    pub number: usize,
    /// State.
    pub state: TrialState,
    /// Parameters by name.
    pub params: BTreeMap<String, Suggestion>,
    /// Values of the objective, one per direction of the study; empty until it is complete. A pruned trial may
    /// have one.
    pub values: Vec<f64>,
    /// Intermediate values, by step.
    pub reports: BTreeMap<i64, f64>,
    /// Attributes set by users.
    pub user_attributes: BTreeMap<String, Value>,
    /// Attributes set by samplers, pruners and the tuner.
    pub system_attributes: BTreeMap<String, Value>,
    /// Time of its start.
    pub started: Option<Timestamp>,
    /// Time of its end.
    pub ended: Option<Timestamp>,
    /// Number in the storage.
    pub(crate) id: usize,
    /// Name of its current or last worker.
    pub(crate) worker: String,
}

/// System attribute with the state from which a paused trial resumes.
pub(crate) const PAUSED_STATE: &str = "opendr:paused_state";
/// System attribute that marks a trial paused by something other than the pruner.
pub(crate) const INTERRUPTED: &str = "opendr:interrupted";

impl TrialRecord {
    /// Returns the value of the objective, if there is exactly one.
    pub fn value(&self) -> Option<f64> {
        match self.values.as_slice() {
            [value] => Some(*value),
            _ => None,
        }
    }

    /// Returns the last reported step and its value.
    pub fn last_report(&self) -> Option<(i64, f64)> {
        self.reports.last_key_value().map(|(step, value)| (*step, *value))
    }

    /// Returns whether the trial is paused and can be resumed.
    pub fn is_paused(&self) -> bool {
        self.state == TrialState::Waiting && self.system_attributes.contains_key(PAUSED_STATE)
    }

    /// Returns whether a user or the death of its worker interrupted the trial; it is then resumed before any other.
    pub fn is_interrupted(&self) -> bool {
        self.is_paused() && self.system_attributes.get(INTERRUPTED) == Some(&Value::Bool(true))
    }

    /// Returns the parameters in the form that learners take.
    ///
    /// # Errors
    /// `InvalidParam` for a choice that is a JSON object, which no learner accepts.
    pub fn param_map(&self) -> Result<ParamMap> {
        let value = |(name, suggestion): (&String, &Suggestion)| {
            let value: ParamValue = serde_json::from_value(suggestion.value()).map_err(|error| {
                Error::invalid_param(format!("{name}: no learner accepts the value {}", suggestion.value()))
                    .with_source(error)
            })?;
            Ok((name.clone(), value))
        };
        self.params.iter().map(value).collect()
    }
}

/// Record of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyRecord {
    /// Name, unique in the storage.
    pub name: String,
    /// Direction of each value of the objective.
    pub directions: Vec<Direction>,
    /// Trials, indexed by number.
    pub trials: Vec<TrialRecord>,
    /// Attributes set by users.
    pub user_attributes: BTreeMap<String, Value>,
    /// Attributes set by samplers, pruners and the tuner.
    pub system_attributes: BTreeMap<String, Value>,
}

impl StudyRecord {
    /// Returns the direction of the first value.
    pub fn direction(&self) -> Direction {
        self.directions.first().copied().unwrap_or(Direction::Minimize)
    }

    /// Returns the complete trial with the best value, the first of equals. `None` without one, or with several directions.
    pub fn best(&self) -> Option<&TrialRecord> {
        let [direction] = self.directions[..] else { return None };
        let loss = |trial: &TrialRecord| trial.value().map_or(f64::INFINITY, |value| direction.loss(value));
        self.complete().min_by(|a, b| loss(a).total_cmp(&loss(b)))
    }

    /// Returns number and first value of each complete trial, where the value is finite.
    pub fn history(&self) -> Vec<[f64; 2]> {
        let values = self.complete().filter_map(|trial| Some([trial.number as f64, *trial.values.first()?]));
        values.filter(|[_, value]| value.is_finite()).collect()
    }

    /// Returns the best value up to each trial of [`history`](Self::history).
    pub fn best_so_far(&self) -> Vec<[f64; 2]> {
        let better: fn(f64, f64) -> f64 = match self.direction() {
            Direction::Minimize => f64::min,
            Direction::Maximize => f64::max,
        };
        let best = self.history().into_iter().scan(f64::NAN, |best, [number, value]| {
            *best = better(*best, value);
            Some([number, *best])
        });
        best.collect()
    }

    /// Returns the Pareto front: the complete trials that no other dominates.
    pub fn pareto_front(&self) -> Vec<&TrialRecord> {
        let complete: Vec<_> = self.complete().collect();
        let losses: Vec<_> = complete.iter().map(|trial| self.losses(trial)).collect();
        let undominated = |at: &usize| !losses.iter().any(|other| dominates(other, &losses[*at]));
        (0..complete.len()).filter(undominated).map(|at| complete[at]).collect()
    }

    /// Returns the complete trials.
    pub fn complete(&self) -> impl Iterator<Item = &TrialRecord> {
        self.trials.iter().filter(|trial| trial.state == TrialState::Complete)
    }

    /// Returns the values of a trial with signs such that less is better.
    pub(crate) fn losses(&self, trial: &TrialRecord) -> Vec<f64> {
        self.directions.iter().zip(&trial.values).map(|(direction, value)| direction.loss(*value)).collect()
    }
}

/// Returns whether losses `a` are nowhere larger than `b` and somewhere smaller.
pub(crate) fn dominates(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a <= b) && a.iter().zip(b).any(|(a, b)| a < b)
}
