//! The `opendr` command, for `python -m opendr` and the script that the wheel installs.

use std::ffi::OsString;

use pyo3::prelude::*;

/// Runs the command and returns its exit code. Learners registered from Python are available.
#[pyfunction]
pub fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| opendr_cli::run(arguments))
}
