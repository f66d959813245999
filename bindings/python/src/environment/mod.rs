//! Environments of the toolkit for Python, and environments of Python for the toolkit.

mod locked;
mod parts;
mod python_environment;
mod shared_array;
mod single;
mod snapshot_text;
mod source;
mod space;
mod vector;

use opendr::environment::EnvironmentSpec;
use opendr::simulation::Registry;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::error::ToPython;
use crate::registry::{field, rows};

pub use shared_array::SharedArray;
pub use single::Environment;
pub use source::GivenEnvironments;
pub use vector::VectorEnvironment;

/// Returns a dictionary for every environment of the registry: its spec and its parameters.
#[pyfunction]
pub fn environments(py: Python<'_>) -> PyResult<Bound<'_, PyList>> {
    let registry = Registry::builtin();
    let tables = registry.ids().map(|id| {
        let registration = registry.get(id).to_python(py)?;
        let environment = registration.make(&Default::default()).to_python(py)?;
        let table = spec_table(py, environment.spec())?;
        table.set_item("params", rows(py, registration.fields(), field)?)?;
        Ok(table)
    });
    PyList::new(py, tables.collect::<PyResult<Vec<_>>>()?)
}

/// Converts a spec to a dictionary.
fn spec_table<'py>(py: Python<'py>, spec: &EnvironmentSpec) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    table.set_item("id", &spec.id)?;
    table.set_item("observation", space::python_from_space(py, &spec.observation)?)?;
    table.set_item("action", space::python_from_space(py, &spec.action)?)?;
    table.set_item("max_episode_steps", spec.max_episode_steps)?;
    table.set_item("reward_range", spec.reward_range)?;
    table.set_item("reward_threshold", spec.reward_threshold)?;
    Ok(table)
}
