//! Running trials.

use std::collections::BTreeMap;

use opendr_engine::params::ParamMap;
use opendr_engine::{Error, Result};
use serde::de::DeserializeOwned;
use serde_json::Value;

use crate::pruner::Advice;
use crate::records::{Suggestion, TrialRecord};
use crate::study::{Outcome, Study, no_trial};

/// A running trial with its parameters; it ends by [`tell`](Self::tell). If it is dropped before,
/// it stays running.
pub struct Trial<'a> {
    pub(super) study: &'a Study,
    pub(super) number: usize,
    pub(super) params: BTreeMap<String, Suggestion>,
    pub(super) resumed: Option<Value>,
}

impl Trial<'_> {
    /// Returns the number in the study.
    pub fn number(&self) -> usize {
        self.number
    }

    /// Returns the parameters; inactive conditional ones are missing.
    pub fn params(&self) -> &BTreeMap<String, Suggestion> {
        &self.params
    }

    /// Returns the parameters in the form that learners take.
    ///
    /// # Errors
    /// As [`TrialRecord::param_map`].
    pub fn param_map(&self) -> Result<ParamMap> {
        self.record()?.param_map()
    }

    /// Returns a parameter of any type.
    ///
    /// # Errors
    /// `InvalidParam` when there is none of this name, for instance because it is inactive, or it has another type.
    pub fn get<T: DeserializeOwned>(&self, name: &str) -> Result<T> {
        let names = || self.params.keys().cloned().collect::<Vec<_>>().join(", ");
        let suggestion = self.params.get(name).ok_or_else(|| {
            Error::invalid_param(format!(
                "trial {} has no parameter {name:?}; it has {}",
                self.number,
                names()
            ))
        })?;
        let value = suggestion.value();
        let wrong =
            |error| Error::invalid_param(format!("{name} = {value} has another type")).with_source(error);
        serde_json::from_value(value.clone()).map_err(wrong)
    }

    /// Returns a parameter that is a number.
    ///
    /// # Errors
    /// As [`Trial::get`].
    pub fn float(&self, name: &str) -> Result<f64> {
        self.get(name)
    }

    /// Returns a parameter that is a whole number.
    ///
    /// # Errors
    /// As [`Trial::get`].
    pub fn int(&self, name: &str) -> Result<i64> {
        self.get(name)
    }

    /// Returns the state with which the trial was paused or interrupted, if it is being resumed.
    pub fn resumed_from(&self) -> Option<&Value> {
        self.resumed.as_ref()
    }

    /// Returns the record of the trial, with its reports before a pause.
    ///
    /// # Errors
    /// `NotFound` when another process has deleted the study.
    pub fn record(&self) -> Result<TrialRecord> {
        self.study
            .inspect(|study| study.trials.get(self.number).cloned())
            .ok_or_else(|| no_trial(self.number))
    }

    /// Reports a value at `step`. Returns the pruner's decision.
    ///
    /// # Errors
    /// As [`Study::report`].
    pub fn report(&self, step: i64, value: f64) -> Result<Advice> {
        self.study.report(self.number, step, value)
    }

    /// Sets a user attribute of the trial.
    ///
    /// # Errors
    /// As [`Study::set_user_attribute`].
    pub fn set_user_attribute(&self, key: &str, value: impl Into<Value>) -> Result<()> {
        self.study.set_user_attribute(self.number, key, value.into())
    }

    /// Saves the state from which the trial resumes if this process dies; without it the trial would be lost.
    ///
    /// # Errors
    /// As [`Study::set_user_attribute`].
    pub fn checkpoint(&self, state: impl Into<Value>) -> Result<()> {
        self.study.checkpoint(self.number, state.into())
    }

    /// Ends or pauses the trial with an outcome.
    ///
    /// # Errors
    /// As [`Study::tell`].
    pub fn tell(self, outcome: Outcome) -> Result<()> {
        self.study.tell(self.number, outcome)
    }
}
