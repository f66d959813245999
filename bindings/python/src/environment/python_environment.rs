//! An environment written in Python, for the toolkit.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use opendr::data::{Image, Layout, PixelFormat};
use opendr::environment::{Environment, EnvironmentSpec, Info, ResetOptions, Step};
use opendr::{Result, ResultExt as _};
use pyo3::exceptions::{PyLookupError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::parts::Parts;
use super::space::space_from_python;
use crate::array::ArrayMemory;
use crate::error::{ToPython, error_from_exception};
use crate::param::python_from_params;

/// An environment of Gymnasium, by an `opendr.simulation._bridge.Bridge` that writes observations into arrays and reads
/// actions from arrays. An exception becomes an error with the exception as its source, so that a training ends as it does
/// for any other error: with its checkpoint.
pub struct PythonEnvironment {
    spec: EnvironmentSpec,
    bridge: Py<PyAny>,
    observation: Parts,
    action: Parts,
}

impl PythonEnvironment {
    /// Wraps the environment of a bridge.
    pub fn new(bridge: &Bound<'_, PyAny>) -> PyResult<Self> {
        let py = bridge.py();
        let spec = spec_of(&bridge.getattr("spec")?.cast_into::<PyDict>()?)?;
        // The bridge writes observations and reads actions, both as float32, hence `of_actions` for both.
        let observation = Parts::of_actions(py, &spec.observation, None)?;
        let action = Parts::of_actions(py, &spec.action, None)?;
        bridge.call_method1("share", (observation.arrays(py)?, action.arrays(py)?))?;
        Ok(Self { spec, bridge: bridge.clone().unbind(), observation, action })
    }

    fn call<T>(&self, what: &str, call: impl FnOnce(&Bound<'_, PyAny>) -> PyResult<T>) -> Result<T> {
        Python::attach(|py| call(self.bridge.bind(py)).map_err(|raised| error_from_exception(py, raised)))
            .context(|| format!("{what} {}", self.spec.id))
    }
}

impl Environment for PythonEnvironment {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        let info = self.call("resetting", |bridge| {
            let options = match options.is_empty() {
                true => None,
                false => Some(python_from_params(bridge.py(), options)?),
            };
            info_from_python(&bridge.call_method1("reset", (seed, options))?)
        })?;
        self.observation.read(observation);
        Ok(info)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        self.action.write(action);
        let step = self.call("stepping", |bridge| {
            let (reward, terminated, truncated, info): (f64, bool, bool, Bound<'_, PyAny>) =
                bridge.call_method0("step")?.extract()?;
            Ok(Step { reward, terminated, truncated, info: info_from_python(&info)? })
        })?;
        self.observation.read(observation);
        Ok(step)
    }

    fn render(&mut self) -> Result<Option<Image>> {
        self.call("rendering", |bridge| {
            let image = bridge.call_method0("render")?;
            if image.is_none() {
                return Ok(None);
            }
            let memory = ArrayMemory::of(&image)?;
            let &[height, width, 3] = memory.shape() else {
                let shape = memory.shape();
                return Err(PyValueError::new_err(format!(
                    "render() returned shape {shape:?}, not height, width, 3"
                )));
            };
            let image = Image::new(memory.to_vec::<u8>()?, width, height, PixelFormat::Rgb, Layout::Hwc);
            image.map(Some).to_python(bridge.py())
        })
    }
}

fn spec_of(table: &Bound<'_, PyDict>) -> PyResult<EnvironmentSpec> {
    let entry = |name: &str| {
        table.get_item(name)?.ok_or_else(|| PyLookupError::new_err(format!("the spec has no {name:?}")))
    };
    let space = |name: &str| space_from_python(entry(name)?.cast::<PyDict>()?);
    let mut spec =
        EnvironmentSpec::new(entry("id")?.extract::<String>()?, space("observation")?, space("action")?);
    spec.max_episode_steps = entry("max_episode_steps")?.extract()?;
    spec.reward_threshold = entry("reward_threshold")?.extract()?;
    Ok(spec)
}

fn info_from_python(info: &Bound<'_, PyAny>) -> PyResult<Info> {
    let mut numbers = Info::default();
    for (key, number) in info.cast::<PyDict>()? {
        if let Some(key) = static_name(&key.extract::<String>()?) {
            numbers.set(key, number.extract()?);
        }
    }
    Ok(numbers)
}

/// Returns a leaked copy of a name, one for equal names. At most 1000 names of at most 100 bytes are kept; for others it returns
/// `None`, so that leaked memory is bounded.
fn static_name(name: &str) -> Option<&'static str> {
    static NAMES: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = names.get(name) {
        return Some(known);
    }
    if names.len() == 1000 || name.len() > 100 {
        return None;
    }
    let name: &'static str = String::leak(name.to_owned());
    names.insert(name);
    Some(name)
}
