//! Progress of long calls, and their interruption by Ctrl-C.

use std::sync::{Mutex, PoisonError};

use opendr::{Progress, Result, Unit};
use opendr_cli::ProgressBar;
use pyo3::prelude::*;

use crate::error::ToPython;

/// The progress bar of the command; work stops when a signal handler of Python raises.
pub struct PythonBar {
    bar: ProgressBar,
    raised: Mutex<Option<PyErr>>,
}

impl PythonBar {
    /// Creates a bar, which prints nothing when `quiet`.
    pub fn new(quiet: bool) -> Self {
        Self { bar: ProgressBar::without_interrupt(quiet), raised: Mutex::default() }
    }

    /// Runs `work` with the GIL released. Raises the exception of a signal handler that stopped it.
    pub fn run<T: Send>(self, py: Python<'_>, work: impl FnOnce(&Self) -> Result<T> + Send) -> PyResult<T> {
        let done = py.detach(|| work(&self));
        match self.raised.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(raised) => Err(raised),
            None => done.to_python(py),
        }
    }
}

impl Progress for PythonBar {
    fn begin(&self, what: &str, total: Option<u64>, unit: Unit) {
        self.bar.begin(what, total, unit);
    }

    fn advance(&self, amount: u64) {
        self.bar.advance(amount);
    }

    fn advance_resumed(&self, amount: u64) {
        self.bar.advance_resumed(amount);
    }

    fn end(&self) {
        self.bar.end();
    }

    fn status(&self, text: &str) {
        self.bar.status(text);
    }

    fn note(&self, line: &str) {
        self.bar.note(line);
    }

    fn stopped(&self) -> bool {
        let mut raised = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
        if raised.is_none() {
            *raised = Python::attach(|py| py.check_signals()).err();
        }
        // The command handles Ctrl-C itself.
        raised.is_some() || opendr_cli::interrupted()
    }
}
