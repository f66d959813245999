//! The class `Study` of Python: a search for hyperparameters.

use std::collections::BTreeMap;
use std::path::PathBuf;

use opendr::tuning::{
    Advice, Asha, CmaEs, Direction, Hyperband, Median, Outcome, QuasiRandom, RandomSearch, SearchSpace,
    Storage, StudyRecord, Tpe, TrialRecord, TrialState, importance_from_study, table_from_study,
};
use opendr::{Error, Result};
use pyo3::prelude::*;
use serde::Deserialize;
use serde_json::{Value, json};

use crate::error::ToPython;

/// A study with one objective. Threads share the object; processes share its journal.
#[pyclass(frozen, module = "opendr._opendr")]
pub struct Study {
    study: opendr::tuning::Study,
}

/// Options of a study.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Options {
    maximize: bool,
    /// File of the journal; in memory when `None`.
    storage: Option<PathBuf>,
    sampler: Sampler,
    seed: u64,
    pruner: Option<Pruner>,
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Sampler {
    Tpe,
    Random,
    QuasiRandom,
    CmaEs,
}

#[derive(Deserialize)]
#[serde(tag = "name", rename_all = "snake_case", deny_unknown_fields)]
enum Pruner {
    Median { startup_trials: usize, warmup_steps: i64 },
    Asha { first: i64, factor: i64 },
    Hyperband { first: i64, last: i64, factor: i64 },
}

#[pymethods]
impl Study {
    #[new]
    fn new(py: Python<'_>, name: &str, options: &str) -> PyResult<Self> {
        let study = py.detach(|| open(name, &from_json(options, "invalid options of a study")?));
        Ok(Self { study: study.to_python(py)? })
    }

    /// Suggests the next trial, in the search space of OpenDR's dictionaries. Returns its number and its parameters.
    fn ask(&self, py: Python<'_>, dictionaries: &str) -> PyResult<(usize, String)> {
        let suggested = py.detach(|| {
            let space = SearchSpace::from_dictionaries(&from_json::<Vec<Value>>(
                dictionaries,
                "invalid hyperparameters",
            )?)?;
            let trial = self.study.ask(&space)?;
            let params: BTreeMap<_, _> = trial.params().iter().map(|(name, it)| (name, it.value())).collect();
            Ok((trial.number(), json!(params).to_string()))
        });
        suggested.to_python(py)
    }

    /// Enqueues a trial with these parameters.
    fn enqueue(&self, py: Python<'_>, params: &str) -> PyResult<()> {
        py.detach(|| self.study.enqueue(&from_json(params, "invalid parameters")?)).to_python(py)
    }

    /// Reports an intermediate value of a trial. Returns what to do: `"continue"`, `"pause"` or `"stop"`.
    fn report(&self, py: Python<'_>, number: usize, step: i64, value: f64) -> PyResult<&'static str> {
        let advice = py.detach(|| self.study.report(number, step, value)).to_python(py)?;
        Ok(match advice {
            Advice::Continue => "continue",
            Advice::Pause => "pause",
            Advice::Stop => "stop",
        })
    }

    /// Sets a user attribute, given as JSON, of a trial.
    fn note(&self, py: Python<'_>, number: usize, key: &str, value: &str) -> PyResult<()> {
        py.detach(|| self.study.set_user_attribute(number, key, from_json(value, "invalid user attribute")?))
            .to_python(py)
    }

    /// Finishes a trial: with its value, as pruned without one, or as failed with the reason.
    #[pyo3(signature = (number, value=None, failed=None))]
    fn tell(
        &self,
        py: Python<'_>,
        number: usize,
        value: Option<f64>,
        failed: Option<String>,
    ) -> PyResult<()> {
        let outcome = match (value, failed) {
            (_, Some(reason)) => Outcome::Failed(reason),
            (Some(value), None) => Outcome::from(value),
            (None, None) => Outcome::Pruned,
        };
        py.detach(|| self.study.tell(number, outcome)).to_python(py)
    }

    /// Reads the entries that other processes have written to the journal.
    fn refresh(&self, py: Python<'_>) -> PyResult<()> {
        py.detach(|| self.study.refresh()).to_python(py)
    }

    /// Returns all trials as JSON.
    fn trials(&self, py: Python<'_>) -> String {
        py.detach(|| {
            self.study.inspect(|study| json!(study.trials.iter().map(trial_json).collect::<Vec<_>>()))
        })
        .to_string()
    }

    /// Returns the best complete trial as JSON.
    fn best(&self, py: Python<'_>) -> Option<String> {
        py.detach(|| self.study.best()).map(|trial| trial_json(&trial).to_string())
    }

    /// Returns a table for the terminal with the newest `rows` trials.
    fn table(&self, py: Python<'_>, rows: usize) -> String {
        py.detach(|| self.study.inspect(|study| table_from_study(study, rows)))
    }

    /// Returns the importance of each parameter.
    fn importance(&self, py: Python<'_>) -> Vec<(String, f64)> {
        py.detach(|| self.study.inspect(importance_from_study))
    }

    #[getter]
    fn maximize(&self) -> bool {
        self.study.inspect(StudyRecord::direction) == Direction::Maximize
    }
}

fn open(name: &str, options: &Options) -> Result<opendr::tuning::Study> {
    let storage = options.storage.as_ref().map_or_else(|| Ok(Storage::memory()), Storage::journal)?;
    let direction = if options.maximize { Direction::Maximize } else { Direction::Minimize };
    let study = opendr::tuning::Study::open(storage, name, &[direction])?;
    let study = match options.sampler {
        Sampler::Tpe => study.with_sampler(Tpe::new(options.seed)),
        Sampler::Random => study.with_sampler(RandomSearch::new(options.seed)),
        Sampler::QuasiRandom => study.with_sampler(QuasiRandom::new(options.seed)),
        Sampler::CmaEs => study.with_sampler(CmaEs::new(options.seed)),
    };
    Ok(match options.pruner {
        None => study,
        Some(Pruner::Median { startup_trials, warmup_steps }) => {
            study.with_pruner(Median { startup_trials, warmup_steps })
        }
        Some(Pruner::Asha { first, factor }) => study.with_pruner(Asha::new(first, factor)?),
        Some(Pruner::Hyperband { first, last, factor }) => {
            study.with_pruner(Hyperband::new(first, last, factor)?)
        }
    })
}

fn from_json<T: for<'de> Deserialize<'de>>(text: &str, what: &str) -> Result<T> {
    serde_json::from_str(text)
        .map_err(|error| Error::invalid_param(format!("{what}: {text}")).with_source(error))
}

fn trial_json(trial: &TrialRecord) -> Value {
    let state = match trial.state {
        TrialState::Running => "running",
        TrialState::Complete => "complete",
        TrialState::Pruned => "pruned",
        TrialState::Failed => "failed",
        TrialState::Waiting => "waiting",
    };
    let params: BTreeMap<_, _> = trial.params.iter().map(|(name, it)| (name, it.value())).collect();
    let reports: BTreeMap<_, _> =
        trial.reports.iter().map(|(step, value)| (step.to_string(), value)).collect();
    json!({
        "number": trial.number, "state": state, "params": params, "value": trial.value(), "reports": reports,
        "notes": trial.user_attributes, "fail_reason": trial.system_attributes.get("fail_reason"),
    })
}
