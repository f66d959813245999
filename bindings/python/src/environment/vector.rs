//! The class `VectorEnvironment` of Python: several environments.

use opendr::environment::{EnvironmentSpec, Info, ResetOptions};
use opendr::simulation::Registry;
use opendr::simulation::vector::{Autoreset, Batch, Seeds, VecEnvironment, VectorOptions};
use opendr::{Error, Result};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use super::locked::Locked;
use super::parts::Parts;
use super::shared_array::{Number, SharedArray};
use super::snapshot_text::{snapshot_from_text, text_from_snapshot};
use super::spec_table;
use crate::error::ToPython;
use crate::param::params_from_python;

/// Environments that are stepped together. Actions and results are arrays shared with NumPy; no Python code runs per
/// environment. `opendr.simulation.VectorEnvironment` wraps it in Gymnasium's interface.
#[pyclass(frozen, module = "opendr._opendr")]
pub struct VectorEnvironment {
    state: Locked<State>,
    spec: EnvironmentSpec,
    observations: Parts,
    final_observations: Parts,
    actions: Parts,
    rewards: Py<SharedArray>,
    terminations: Py<SharedArray>,
    truncations: Py<SharedArray>,
}

struct State {
    worlds: Box<dyn VecEnvironment>,
    batch: Batch,
    actions: Vec<f32>,
}

/// Info values by name: the name, a value for each environment, and whether the environment has one.
type Infos = Vec<(&'static str, Vec<f64>, Vec<bool>)>;

#[pymethods]
impl VectorEnvironment {
    /// Creates `count` environments `id` of the registry; `autoreset` is a mode of Gymnasium.
    #[new]
    fn new(
        py: Python<'_>,
        id: &str,
        params: &Bound<'_, PyDict>,
        count: usize,
        threads: usize,
        autoreset: &str,
    ) -> PyResult<Self> {
        let autoreset = autoreset_of_name(autoreset).to_python(py)?;
        let params = params_from_python(params)?;
        let options = VectorOptions { autoreset, threads, ..VectorOptions::new(count) };
        let worlds = py.detach(|| Registry::builtin().get(id)?.make_vec(&params, options)).to_python(py)?;
        let spec = worlds.spec().clone();
        let observations = |count| Parts::of_observations(py, &spec.observation, Some(count));
        let finals = if autoreset == Autoreset::SameStep { count } else { 0 };
        let array = |number| Py::new(py, SharedArray::new(number, vec![count]).to_python(py)?);
        Ok(Self {
            observations: observations(count)?,
            final_observations: observations(finals)?,
            actions: Parts::of_actions(py, &spec.action, Some(count))?,
            rewards: array(Number::F64)?,
            terminations: array(Number::Bool)?,
            truncations: array(Number::Bool)?,
            state: Locked::new(State {
                batch: Batch::new(&spec, count),
                actions: vec![0.0; spec.action.len() * count],
                worlds,
            }),
            spec,
        })
    }

    /// Name, spaces and limits of each environment.
    #[getter]
    fn spec<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        spec_table(py, &self.spec)
    }

    /// Arrays of the observations, one for each part of the space.
    #[getter]
    fn observations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        self.observations.arrays(py)
    }

    /// Arrays of the final observations of ended episodes, in the mode `SameStep`.
    #[getter]
    fn final_observations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        self.final_observations.arrays(py)
    }

    /// Arrays of the actions, one for each part of the space, which the caller writes.
    #[getter]
    fn actions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        self.actions.arrays(py)
    }

    /// Array of the rewards.
    #[getter]
    fn rewards(&self, py: Python<'_>) -> Py<SharedArray> {
        self.rewards.clone_ref(py)
    }

    /// Array of the flags `terminated`.
    #[getter]
    fn terminations(&self, py: Python<'_>) -> Py<SharedArray> {
        self.terminations.clone_ref(py)
    }

    /// Array of the flags `truncated`.
    #[getter]
    fn truncations(&self, py: Python<'_>) -> Py<SharedArray> {
        self.truncations.clone_ref(py)
    }

    /// Begins episodes in the environments of `mask`, by default in all; `seeds` has a seed or `None` for each. Returns the infos.
    #[pyo3(signature = (seed=None, seeds=None, options=None, mask=None))]
    fn reset<'py>(
        &self,
        py: Python<'py>,
        seed: Option<u64>,
        seeds: Option<Vec<Option<u64>>>,
        options: Option<&Bound<'py, PyDict>>,
        mask: Option<Vec<bool>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let options = options.map_or_else(|| Ok(ResetOptions::new()), params_from_python)?;
        let infos = self.state.with(py, |State { worlds, batch, .. }| {
            let seeds = match (&seeds, seed) {
                (Some(seeds), _) => Seeds::Each(seeds),
                (None, Some(seed)) => Seeds::From(seed),
                (None, None) => Seeds::Random,
            };
            worlds.reset(seeds, &options, mask.as_deref(), batch)?;
            self.write(batch);
            Ok(gathered(&batch.infos, |index| mask.as_ref().is_none_or(|mask| mask[index])))
        })?;
        python_from_infos(py, infos)
    }

    /// Takes a step in every environment. Returns the infos, and the final infos when episodes ended in the mode `SameStep`.
    fn step<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyDict>, Option<Bound<'py, PyDict>>)> {
        let (infos, ends) = self.state.with(py, |State { worlds, batch, actions }| {
            self.actions.read(actions);
            worlds.step(actions, batch)?;
            self.write(batch);
            let infos = gathered(&batch.infos, |_| true);
            let over = |index: usize| batch.terminated[index] || batch.truncated[index];
            if worlds.autoreset() != Autoreset::SameStep || !(0..batch.count()).any(over) {
                return Ok((infos, None));
            }
            self.final_observations.write(&batch.final_observations);
            Ok((infos, Some(gathered(&batch.final_infos, over))))
        })?;
        let ends = ends.map(|ends| python_from_infos(py, ends)).transpose()?;
        Ok((python_from_infos(py, infos)?, ends))
    }

    /// Returns the current state as text.
    fn snapshot(&self, py: Python<'_>) -> PyResult<String> {
        self.state.with(py, |state| text_from_snapshot(&state.worlds.snapshot()?))
    }

    /// Restores the state of a snapshot.
    fn restore(&self, py: Python<'_>, snapshot: &str) -> PyResult<()> {
        self.state.with(py, |state| state.worlds.restore(&snapshot_from_text(snapshot)?))
    }
}

impl VectorEnvironment {
    fn write(&self, batch: &Batch) {
        self.observations.write(&batch.observations);
        self.rewards.get().write_doubles(batch.rewards.iter().copied());
        self.terminations.get().write_flags(batch.terminated.iter().copied());
        self.truncations.get().write_flags(batch.truncated.iter().copied());
    }
}

fn autoreset_of_name(name: &str) -> Result<Autoreset> {
    match name {
        "NextStep" => Ok(Autoreset::NextStep),
        "SameStep" => Ok(Autoreset::SameStep),
        "Disabled" => Ok(Autoreset::Disabled),
        _ => Err(Error::invalid_param(format!(
            "unknown autoreset mode {name:?}; the modes are \"NextStep\", \"SameStep\" and \"Disabled\""
        ))),
    }
}

/// Gathers the info values of the `selected` environments, by name.
fn gathered(infos: &[Info], selected: impl Fn(usize) -> bool) -> Infos {
    let mut gathered = Infos::new();
    for (index, info) in infos.iter().enumerate().filter(|(index, _)| selected(*index)) {
        for (key, number) in info.iter() {
            let place = gathered.iter().position(|(name, ..)| *name == key).unwrap_or_else(|| {
                gathered.push((key, vec![0.0; infos.len()], vec![false; infos.len()]));
                gathered.len() - 1
            });
            let (_, numbers, has) = &mut gathered[place];
            (numbers[index], has[index]) = (number, true);
        }
    }
    gathered
}

/// Converts infos to a dictionary: by name, the values and the mask of environments that have one.
fn python_from_infos(py: Python<'_>, infos: Infos) -> PyResult<Bound<'_, PyDict>> {
    let table = PyDict::new(py);
    for (key, numbers, has) in infos {
        let values = SharedArray::writable(Number::F64, vec![numbers.len()]).to_python(py)?;
        values.write_doubles(numbers.into_iter());
        let mask = SharedArray::writable(Number::Bool, vec![has.len()]).to_python(py)?;
        mask.write_flags(has.into_iter());
        table.set_item(key, (Py::new(py, values)?, Py::new(py, mask)?))?;
    }
    Ok(table)
}
