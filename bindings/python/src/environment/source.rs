//! Environments that Python names or makes, for a learner to act in.

use opendr::environment::{Environment, EnvironmentSource};
use opendr::simulation::RegisteredSource;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::python_environment::PythonEnvironment;
use crate::error::{ToPython, error_from_exception};
use crate::param::params_from_python;

/// A name with parameters, or a function that makes bridges to environments written in Python.
pub enum GivenEnvironments {
    /// Of the registry.
    Registered(RegisteredSource),
    /// Made by Python.
    Made(Py<PyAny>),
}

impl GivenEnvironments {
    /// What a pair of id and parameters, or a function without arguments, makes.
    pub fn from_python(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let Ok((id, params)) = object.extract::<(String, Bound<'_, PyDict>)>() else {
            return Ok(Self::Made(object.clone().unbind()));
        };
        let params = params_from_python(&params)?;
        RegisteredSource::new(&id, &params).to_python(object.py()).map(Self::Registered)
    }
}

impl EnvironmentSource for GivenEnvironments {
    fn make(&self) -> opendr::Result<Box<dyn Environment>> {
        match self {
            Self::Registered(source) => source.make(),
            Self::Made(function) => Python::attach(|py| {
                let made = function.bind(py).call0().and_then(|bridge| PythonEnvironment::new(&bridge));
                made.map(|made| Box::new(made) as Box<dyn Environment>)
                    .map_err(|raised| error_from_exception(py, raised))
            }),
        }
    }
}
