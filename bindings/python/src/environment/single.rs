//! The class `Environment` of Python: a single environment.

use opendr::environment::{Environment as World, EnvironmentSpec, Info, ResetOptions};
use opendr::simulation::wrappers::Checked;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use super::locked::Locked;
use super::parts::Parts;
use super::python_environment::PythonEnvironment;
use super::snapshot_text::{snapshot_from_text, text_from_snapshot};
use super::spec_table;
use crate::error::ToPython;
use crate::param::params_from_python;
use crate::pixels::Pixels;

/// An environment whose observations and actions are arrays shared with NumPy: `step` reads the action from one and writes
/// the observation to another. `opendr.simulation.Environment` wraps it in Gymnasium's interface.
#[pyclass(frozen, module = "opendr._opendr")]
pub struct Environment {
    state: Locked<State>,
    spec: EnvironmentSpec,
    observation: Parts,
    action: Parts,
}

struct State {
    world: Box<dyn World>,
    observation: Vec<f32>,
    action: Vec<f32>,
}

impl Environment {
    fn of(py: Python<'_>, world: Box<dyn World>) -> PyResult<Self> {
        let spec = world.spec().clone();
        Ok(Self {
            observation: Parts::of_observations(py, &spec.observation, None)?,
            action: Parts::of_actions(py, &spec.action, None)?,
            state: Locked::new(State {
                world,
                observation: vec![0.0; spec.observation.len()],
                action: vec![0.0; spec.action.len()],
            }),
            spec,
        })
    }
}

#[pymethods]
impl Environment {
    /// Creates the environment `id` of the registry.
    #[new]
    fn new(py: Python<'_>, id: &str, params: &Bound<'_, PyDict>) -> PyResult<Self> {
        let params = params_from_python(params)?;
        let world = py.detach(|| opendr::environments::registration(id)?.make(&params)).to_python(py)?;
        Self::of(py, world)
    }

    /// Wraps an environment of Python in the form that learners of the toolkit receive; `bridge` is an
    /// `opendr.simulation._bridge.Bridge`.
    #[staticmethod]
    fn of_python(py: Python<'_>, bridge: &Bound<'_, PyAny>) -> PyResult<Self> {
        Self::of(py, Box::new(Checked::new(PythonEnvironment::new(bridge)?)))
    }

    /// Name, spaces and limits.
    #[getter]
    fn spec<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        spec_table(py, &self.spec)
    }

    /// Arrays of the observation, one for each part of the space.
    #[getter]
    fn observation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        self.observation.arrays(py)
    }

    /// Arrays of the action, one for each part of the space, which the caller writes.
    #[getter]
    fn action<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        self.action.arrays(py)
    }

    /// Begins an episode. Returns Gymnasium's `info`.
    #[pyo3(signature = (seed=None, options=None))]
    fn reset<'py>(
        &self,
        py: Python<'py>,
        seed: Option<u64>,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let options = options.map_or_else(|| Ok(ResetOptions::new()), params_from_python)?;
        let info = self.state.with(py, |state| {
            let info = state.world.reset(seed, &options, &mut state.observation)?;
            self.observation.write(&state.observation);
            Ok(info)
        })?;
        python_from_info(py, &info)
    }

    /// Takes a step. Returns reward, terminated, truncated, `info`.
    fn step<'py>(&self, py: Python<'py>) -> PyResult<(f64, bool, bool, Bound<'py, PyDict>)> {
        let step = self.state.with(py, |state| {
            self.action.read(&mut state.action);
            let step = state.world.step(&state.action, &mut state.observation)?;
            self.observation.write(&state.observation);
            Ok(step)
        })?;
        Ok((step.reward, step.terminated, step.truncated, python_from_info(py, &step.info)?))
    }

    /// Renders the current state as an image.
    fn render(&self, py: Python<'_>) -> PyResult<Option<Pixels>> {
        let image = self.state.with(py, |state| state.world.render())?;
        image.map(Pixels::new).transpose().to_python(py)
    }

    /// Returns the current state as text.
    fn snapshot(&self, py: Python<'_>) -> PyResult<String> {
        self.state.with(py, |state| text_from_snapshot(&state.world.snapshot()?))
    }

    /// Restores the state of a snapshot.
    fn restore(&self, py: Python<'_>, snapshot: &str) -> PyResult<()> {
        self.state.with(py, |state| state.world.restore(&snapshot_from_text(snapshot)?))
    }
}

fn python_from_info<'py>(py: Python<'py>, info: &Info) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    info.iter().try_for_each(|(key, number)| table.set_item(key, number))?;
    Ok(table)
}
