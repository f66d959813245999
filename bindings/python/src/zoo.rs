//! Downloads from the zoo, and the runtime.

use std::path::PathBuf;

use opendr::zoo::{Zoo, ZooOptions};
use opendr::{Device, Result, inference};
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

/// Returns a line that describes the runtime of networks on `device`.
#[pyfunction]
#[pyo3(signature = (device="auto"))]
pub fn runtime(py: Python<'_>, device: &str) -> PyResult<String> {
    device.parse::<Device>().and_then(inference::describe).to_python(py)
}
