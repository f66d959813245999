//! The `opendr` command, for `python -m opendr` and the script that the wheel installs.

use std::ffi::OsString;

use pyo3::prelude::*;

use crate::error::error_from_exception;

/// Runs the command and returns its exit code. Learners registered from Python are available; commands with `--ray` are carried out
/// by `opendr._cluster_command`.
#[pyfunction]
pub fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    opendr_cli::set_cluster(|call| {
        Python::attach(|py| {
            let run = py.import("opendr._cluster_command").and_then(|module| module.getattr("run"));
            let done = run.and_then(|run| run.call1((call,))).and_then(|done| done.extract());
            done.map_err(|raised| error_from_exception(py, raised))
        })
    });
    py.detach(|| opendr_cli::run(arguments))
}
