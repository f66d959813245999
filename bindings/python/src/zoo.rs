//! Models of the zoo.

use std::path::PathBuf;

use opendr::zoo::{Zoo, ZooOptions};
use opendr::{Device, Result, inference};
use pyo3::prelude::*;

use crate::bar::PythonBar;
use crate::error::ToPython;

/// The zoo as the environment sets it up.
pub fn open() -> Result<Zoo> {
    Zoo::new(ZooOptions::from_env()?)
}

/// The name of a learner's model in the zoo.
pub fn spec(name: &str, variant: Option<&str>) -> String {
    variant.map_or_else(|| name.to_owned(), |variant| format!("{name}/{variant}"))
}

/// Gets a learner's pretrained model into the cache, and copies it to the folder `to` where one is given; its folder.
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

/// Gets a sample picture into the cache; its file.
#[pyfunction]
#[pyo3(signature = (name, verbose=true))]
pub fn sample(py: Python<'_>, name: &str, verbose: bool) -> PyResult<PathBuf> {
    PythonBar::new(!verbose).run(py, |bar| open()?.sample(name, bar))
}

/// The names of the models of a learner, the default first.
#[pyfunction]
pub fn models(py: Python<'_>, name: &str) -> PyResult<Vec<String>> {
    let zoo = open().to_python(py)?;
    let mut items: Vec<_> = zoo.items().filter(|item| item.card.learner == name).collect();
    items.sort_by_key(|item| !item.variant.default);
    Ok(items.iter().map(|item| item.variant.name.clone()).collect())
}

/// One line about the runtime that networks run on.
#[pyfunction]
#[pyo3(signature = (device="auto"))]
pub fn runtime(py: Python<'_>, device: &str) -> PyResult<String> {
    device.parse::<Device>().and_then(inference::describe).to_python(py)
}
