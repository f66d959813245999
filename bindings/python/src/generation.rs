//! Rendered data sets of Python.

use std::path::PathBuf;

use opendr::data_generation::{GeneratedWorld, GenerationOptions, generate};
use opendr::datasets::Problems;
use opendr::inference;
use opendr::params::{Param, ParamValue};
use opendr::{Error, Result};
use pyo3::prelude::*;

use crate::bar::PythonBar;
use crate::error::ToPython;

/// Renders a labelled data set of a world; returns the number of samples, the format, and the path of the contact sheet.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "keyword arguments of a Python function")]
pub fn render(
    py: Python<'_>,
    world: String,
    out: PathBuf,
    frames: usize,
    size: [usize; 2],
    seed: u64,
    format: Option<String>,
    split: Option<String>,
    geometry: bool,
    verbose: bool,
) -> PyResult<(usize, String, Option<PathBuf>)> {
    let world = world_of(&world).to_python(py)?;
    let threads = inference::default_threads().to_python(py)?;
    let options = GenerationOptions { frames, size, seed, format, split, geometry, threads };
    let generated =
        PythonBar::new(!verbose).run(py, |bar| generate(world, &out, &options, &Problems::default(), bar))?;
    Ok((generated.samples, generated.format, generated.contact_sheet))
}

fn world_of(name: &str) -> Result<GeneratedWorld> {
    GeneratedWorld::from_value(&ParamValue::Text(name.to_owned())).ok_or_else(|| {
        Error::invalid_param(format!(
            "no world {name:?}; render one of {}",
            GeneratedWorld::CHOICES.join(", ")
        ))
    })
}
