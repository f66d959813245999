//! Downloads from the zoo, and the runtime.

use std::path::PathBuf;

use opendr::zoo::{ModelFilter, Zoo, ZooOptions};
use opendr::{Device, Error, Result, inference};
use pyo3::prelude::*;

use crate::bar::PythonBar;
use crate::error::ToPython;

/// Opens the zoo that the environment variables configure.
pub fn open() -> Result<Zoo> {
    Zoo::new(ZooOptions::from_env()?)
}

/// Returns the name of a learner's model in the zoo.
pub fn spec(name: &str, variant: Option<&str>) -> String {
    variant.map_or_else(|| name.to_owned(), |variant| format!("{name}/{variant}"))
}

/// Downloads a learner's pretrained model into the cache, and copies it to the folder `to` if given. Returns its folder.
#[pyfunction]
#[pyo3(signature = (name, variant=None, to=None, verbose=true))]
pub fn download(
    py: Python<'_>,
    name: &str,
    variant: Option<&str>,
    to: Option<PathBuf>,
    verbose: bool,
) -> PyResult<PathBuf> {
    let spec = spec(name, variant);
    PythonBar::new(!verbose).run(py, |bar| open()?.download(&spec, to.as_deref(), bar))
}

/// Downloads a sample file into the cache. Returns its path.
#[pyfunction]
#[pyo3(signature = (name, verbose=true))]
pub fn sample(py: Python<'_>, name: &str, verbose: bool) -> PyResult<PathBuf> {
    PythonBar::new(!verbose).run(py, |bar| open()?.sample(name, bar))
}

/// Returns the names of the variants of a learner's model, the default first.
#[pyfunction]
pub fn models(py: Python<'_>, name: &str) -> PyResult<Vec<String>> {
    let zoo = open().to_python(py)?;
    let mut items: Vec<_> = zoo.items().filter(|item| item.card.learner == name).collect();
    items.sort_by_key(|item| !item.variant.default);
    Ok(items.iter().map(|item| item.variant.name.clone()).collect())
}

/// Returns the models of the zoo as a JSON array.
#[pyfunction]
#[pyo3(signature = (task=None, grade=None, commercial=false, cached=false))]
pub fn list_models(
    py: Python<'_>,
    task: Option<&str>,
    grade: Option<&str>,
    commercial: bool,
    cached: bool,
) -> PyResult<String> {
    let list = || -> Result<String> {
        let filter = ModelFilter {
            task: task.map(str::parse).transpose()?,
            grade: grade.map(str::parse).transpose()?,
            commercial,
            cached,
        };
        serde_json::to_string(&opendr::models(&open()?, &filter))
            .map_err(|error| Error::internal("the models cannot be written as JSON").with_source(error))
    };
    list().to_python(py)
}

/// Returns a line that describes the runtime of networks on `device`.
#[pyfunction]
#[pyo3(signature = (device="auto"))]
pub fn runtime(py: Python<'_>, device: &str) -> PyResult<String> {
    device.parse::<Device>().and_then(inference::describe).to_python(py)
}
