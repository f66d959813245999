//! State behind a mutex that is locked only without the GIL.

use std::sync::{Mutex, PoisonError};

use opendr::Result;
use pyo3::prelude::*;

use crate::error::ToPython;

/// A mutex whose state is accessed with the GIL released, so that waiting threads do not block Python.
pub struct Locked<S>(Mutex<S>);

impl<S: Send> Locked<S> {
    pub fn new(state: S) -> Self {
        Self(Mutex::new(state))
    }

    /// Calls `work` on the state with the GIL released.
    pub fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut S) -> Result<T> + Send,
    ) -> PyResult<T> {
        py.detach(|| work(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))).to_python(py)
    }
}
