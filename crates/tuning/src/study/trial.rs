//! A trial that is being carried out.

use std::collections::BTreeMap;

use opendr_engine::params::ParamMap;
use opendr_engine::{Error, Result};
use serde::de::DeserializeOwned;
use serde_json::Value;

use crate::pruner::Advice;
use crate::records::{Suggestion, TrialRecord};
use crate::study::{Outcome, Study, no_trial};

/// A trial that is being carried out: its parameters, and the way to tell what comes of them. One that is dropped without
/// having been told of stays running.
pub struct Trial<'a> {
    pub(super) study: &'a Study,
    pub(super) number: usize,
    pub(super) params: BTreeMap<String, Suggestion>,
    pub(super) resumed: Option<Value>,
}

impl Trial<'_> {
    /// Its number in the study.
    pub fn number(&self) -> usize {
        self.number
    }

    /// Its parameters; those whose condition does not hold are missing.
    pub fn params(&self) -> &BTreeMap<String, Suggestion> {
        &self.params
    }

    /// Its parameters as learners take them.
    ///
    /// # Errors
    /// As [`TrialRecord::param_map`].
    pub fn param_map(&self) -> Result<ParamMap> {
        self.record()?.param_map()
    }

    /// A parameter of any type.
    ///
    /// # Errors
    /// `InvalidParam` when there is none of this name, as when its condition does not hold, or it is of another type.
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
            |error| Error::invalid_param(format!("{name} = {value} is of another type")).with_source(error);
        serde_json::from_value(value.clone()).map_err(wrong)
    }

    /// A parameter that is a number.
    ///
    /// # Errors
    /// As [`Trial::get`].
    pub fn float(&self, name: &str) -> Result<f64> {
        self.get(name)
    }

    /// A parameter that is a whole number.
    ///
    /// # Errors
    /// As [`Trial::get`].
    pub fn int(&self, name: &str) -> Result<i64> {
        self.get(name)
    }

    /// The state with which the trial was paused or interrupted, when it is to go on from there.
    pub fn resumed_from(&self) -> Option<&Value> {
        self.resumed.as_ref()
    }

    /// The trial as the study knows it, with what it reported before it was paused.
    ///
    /// # Errors
    /// `NotFound` when another process has deleted the study.
    pub fn record(&self) -> Result<TrialRecord> {
        self.study
            .inspect(|study| study.trials.get(self.number).cloned())
            .ok_or_else(|| no_trial(self.number))
    }

    /// Notes what was measured at `step`, and asks what to do.
    ///
    /// # Errors
    /// As [`Study::report`].
    pub fn report(&self, step: i64, value: f64) -> Result<Advice> {
        self.study.report(self.number, step, value)
    }

    /// Notes something about the trial.
    ///
    /// # Errors
    /// As [`Study::note`].
    pub fn note(&self, key: &str, value: impl Into<Value>) -> Result<()> {
        self.study.note(self.number, key, value.into())
    }

    /// Keeps the state from which the trial goes on should this process die; without any, the trial is then lost.
    ///
    /// # Errors
    /// As [`Study::note`].
    pub fn checkpoint(&self, state: impl Into<Value>) -> Result<()> {
        self.study.checkpoint(self.number, state.into())
    }

    /// Ends the trial, for good or for now.
    ///
    /// # Errors
    /// As [`Study::tell`].
    pub fn tell(self, outcome: Outcome) -> Result<()> {
        self.study.tell(self.number, outcome)
    }
}
