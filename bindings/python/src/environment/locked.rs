//! A state that one thread at a time works on, while others may run Python.

use std::sync::{Mutex, PoisonError};

use opendr::Result;
use pyo3::prelude::*;

use crate::error::ToPython;

pub struct Locked<S>(Mutex<S>);

impl<S: Send> Locked<S> {
    pub fn new(state: S) -> Self {
        Self(Mutex::new(state))
    }

    /// Works on the state with the interpreter's lock released.
    pub fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut S) -> Result<T> + Send,
    ) -> PyResult<T> {
        py.detach(|| work(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))).to_python(py)
    }
}
