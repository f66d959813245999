//! The class `OnlineAdapter` of Python: a loaded policy that is adapted while it controls.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::{SystemTime, UNIX_EPOCH};

use opendr::control::online::{AdaptationParams, NeuralPolicy, OnlineAdapter as Adapter};
use opendr::environment::{Controller as _, EnvironmentSource as _};
use opendr::model::Model;
use opendr::params::Params as _;
use opendr::rl::EvaluationProtocol;
use opendr::{Error, OnlineTuning};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::bar::PythonBar;
use crate::environment::GivenEnvironments;
use crate::error::ToPython;
use crate::handle::Handle;
use crate::param::params_from_python;
use crate::report::json_of;

/// An adapter around a loaded policy. Calls from several threads are serialised.
#[pyclass(frozen, module = "opendr._opendr")]
pub struct OnlineAdapter {
    tuning: OnlineTuning,
    params: AdaptationParams,
    adapter: Mutex<Adapter<NeuralPolicy>>,
}

impl OnlineAdapter {
    fn with<R: Send>(&self, py: Python<'_>, work: impl FnOnce(&mut Adapter<NeuralPolicy>) -> R + Send) -> R {
        py.detach(|| work(&mut self.adapter.lock().unwrap_or_else(PoisonError::into_inner)))
    }
}

#[pymethods]
impl OnlineAdapter {
    /// Calibrates the policy of a learner in `env` and puts an adapter around it.
    #[new]
    fn new(
        py: Python<'_>,
        learner: &Bound<'_, Handle>,
        env: &Bound<'_, PyAny>,
        params: &Bound<'_, PyDict>,
    ) -> PyResult<Self> {
        let (env, given) = (GivenEnvironments::from_python(env)?, params_from_python(params)?);
        let handle = learner.get();
        let made = py.detach(|| {
            let mut params = AdaptationParams::default();
            given.iter().try_for_each(|(name, value)| params.set(name, value.clone()))?;
            let tuning = handle.with_learner(|learner| OnlineTuning::new(learner, &env))?;
            let adapter = Mutex::new(tuning.adapter(params.clone())?);
            Ok(Self { tuning, params, adapter })
        });
        made.to_python(py)
    }

    /// Returns the action for an observation, and learns.
    fn act(&self, py: Python<'_>, observation: Vec<f32>) -> PyResult<Vec<f32>> {
        let acted = self.with(py, |adapter| {
            let mut action = vec![0.0; adapter.axes()];
            adapter.act(&observation, &mut action).map(|()| action)
        });
        acted.to_python(py)
    }

    /// Begins another episode: what was learned stays.
    fn reset(&self, py: Python<'_>) {
        self.with(py, |adapter| adapter.reset());
    }

    /// Restores the base.
    fn restore_base(&self, py: Python<'_>) {
        self.with(py, |adapter| adapter.restore_base());
    }

    /// Switches learning on again.
    fn rearm(&self, py: Python<'_>) {
        self.with(py, |adapter| adapter.rearm());
    }

    /// Steps so far, and in how many of them the weights learned.
    #[getter]
    fn steps(&self, py: Python<'_>) -> (u64, u64) {
        let [steps, updates] = self.with(py, |adapter| adapter.steps());
        (steps, updates)
    }

    /// Norm of the weights.
    #[getter]
    fn distance(&self, py: Python<'_>) -> f32 {
        self.with(py, |adapter| adapter.distance())
    }

    /// Whether learning was switched off after repeated rollbacks.
    #[getter]
    fn is_disarmed(&self, py: Python<'_>) -> bool {
        self.with(py, |adapter| adapter.is_disarmed())
    }

    /// The log of events as JSON.
    fn log(&self, py: Python<'_>) -> PyResult<String> {
        self.with(py, |adapter| json_of(adapter.log())).to_python(py)
    }

    /// Saves the adapted policy as a new model.
    fn save(&self, py: Python<'_>, path: PathBuf, adapted_on: &str) -> PyResult<()> {
        let saved = self.with(py, |adapter| {
            let now = SystemTime::now().duration_since(UNIX_EPOCH);
            let now = now.map_err(|error| {
                Error::invalid_input("the clock of this machine is before 1970; set it").with_source(error)
            })?;
            adapter.save(&path, adapted_on, now.as_secs()).map(drop)
        });
        saved.to_python(py)
    }

    /// Resumes from a model that was saved from the same base. Returns its lineage as JSON.
    fn load(&self, py: Python<'_>, path: PathBuf) -> PyResult<String> {
        self.with(py, |adapter| json_of(&adapter.load(&Model::open(&path)?)?)).to_python(py)
    }

    /// Compares frozen, adapted and conventional controller on the same episodes. Returns the report as JSON and as text.
    fn compare(
        &self,
        py: Python<'_>,
        env: &Bound<'_, PyAny>,
        episodes: u64,
        first_seed: u64,
        verbose: bool,
    ) -> PyResult<(String, String)> {
        let env = GivenEnvironments::from_python(env)?;
        PythonBar::new(!verbose).run(py, |bar| {
            let protocol = EvaluationProtocol { episodes, first_seed, ..EvaluationProtocol::default() };
            let report = self.tuning.compare(env.make()?.as_mut(), &self.params, &protocol, bar)?;
            Ok((json_of(&report)?, report.to_string()))
        })
    }
}
