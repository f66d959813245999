//! Environments for trainings, named or created by Python.

use opendr::environment::{Environment, EnvironmentSource};
use opendr::simulation::RegisteredSource;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::python_environment::PythonEnvironment;
use crate::error::{ToPython, error_from_exception};
use crate::param::params_from_python;

/// The environment argument of a learner's method: an id with parameters, or a function that returns bridges to environments
/// written in Python.
pub enum GivenEnvironments {
    /// An environment of the registry.
    Registered(RegisteredSource),
    /// A Python function that returns a bridge.
    Function(Py<PyAny>),
}

impl GivenEnvironments {
    /// Accepts a pair of id and parameters, or a function without arguments.
    pub fn from_python(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let Ok((id, params)) = object.extract::<(String, Bound<'_, PyDict>)>() else {
            return Ok(Self::Function(object.clone().unbind()));
        };
        let params = params_from_python(&params)?;
        opendr::environments::source(&id, &params).to_python(object.py()).map(Self::Registered)
    }
}

impl EnvironmentSource for GivenEnvironments {
    fn make(&self) -> opendr::Result<Box<dyn Environment>> {
        match self {
            Self::Registered(source) => source.make(),
            Self::Function(function) => Python::attach(|py| {
                let environment =
                    function.bind(py).call0().and_then(|bridge| PythonEnvironment::new(&bridge));
                environment
                    .map(|environment| Box::new(environment) as Box<dyn Environment>)
                    .map_err(|raised| error_from_exception(py, raised))
            }),
        }
    }
}
