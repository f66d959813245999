//! Errors as exceptions: one class per kind, made in `opendr/_errors.py`.

use opendr::Error;
use pyo3::exceptions::{PyNotImplementedError, PyRuntimeError};
use pyo3::prelude::*;

/// Converts an error to an exception, whose class is that of the error's kind and whose text is the error's message.
pub fn exception(py: Python<'_>, error: &Error) -> PyErr {
    // An exception raised by a Python learner is raised unchanged.
    if let Some(raised) = std::error::Error::source(error).and_then(|source| source.downcast_ref::<PyErr>()) {
        return raised.clone_ref(py);
    }
    let classes = py.import("opendr._errors").and_then(|module| module.getattr("BY_KIND"));
    let class = classes.and_then(|classes| classes.get_item(error.kind().name()));
    match class.and_then(|class| class.call1((error.to_string(),))) {
        Ok(value) => PyErr::from_value(value),
        Err(_) => PyRuntimeError::new_err(error.to_string()),
    }
}

/// Converts a Python exception to an error with the exception as its source.
pub fn error_from_exception(py: Python<'_>, raised: PyErr) -> Error {
    let text = raised.value(py).to_string();
    if raised.is_instance_of::<PyNotImplementedError>(py) {
        return Error::unsupported(text).with_source(raised);
    }
    let name = raised.get_type(py).name().map(|name| name.to_string()).unwrap_or_default();
    Error::internal(format!("{name}: {text}")).with_source(raised)
}

/// Conversion of results of the toolkit to results of Python.
pub trait ToPython<T> {
    /// Converts the error to an exception.
    fn to_python(self, py: Python<'_>) -> PyResult<T>;
}

impl<T> ToPython<T> for opendr::Result<T> {
    fn to_python(self, py: Python<'_>) -> PyResult<T> {
        self.map_err(|error| exception(py, &error))
    }
}
