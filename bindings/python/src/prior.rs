//! Priors of Python: functions that policies are trained on top of.

use opendr::environment::Controller;
use opendr::rl::prior::{BoxedController, Prior, PriorId};
use opendr::{Error, Result};
use pyo3::prelude::*;
use pyo3::types::PyList;

use crate::error::{ToPython, error_from_exception};

/// A controller that calls a Python function with the numbers of an observation.
struct Function(Py<PyAny>);

impl Controller for Function {
    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        let numbers = Python::attach(|py| {
            let call = || -> PyResult<Vec<f32>> {
                self.0
                    .bind(py)
                    .call1((PyList::new(py, observation)?,))?
                    .try_iter()?
                    .map(|item| item?.extract())
                    .collect()
            };
            call().map_err(|raised| error_from_exception(py, raised))
        })?;
        if numbers.len() != action.len() {
            return Err(Error::invalid_input(format!(
                "the prior returns {} numbers, but the action has {}; return all of them",
                numbers.len(),
                action.len()
            )));
        }
        action.copy_from_slice(&numbers);
        Ok(())
    }
}

/// Makes `function` a prior of this process.
#[pyfunction]
pub fn register_prior(
    py: Python<'_>,
    name: String,
    version: u32,
    function: Py<PyAny>,
    about: String,
) -> PyResult<()> {
    let make = move |_: &_| -> Result<BoxedController> {
        Ok(Box::new(Function(Python::attach(|py| function.clone_ref(py)))))
    };
    Prior::new(name, version, make).about(about).register().to_python(py)
}

/// Returns name, version and description of every prior.
#[pyfunction]
pub fn priors() -> Vec<(String, u32, String)> {
    let row = |prior: &Prior| {
        let PriorId { name, version } = prior.id().clone();
        (name, version, prior.description().to_owned())
    };
    Prior::all().iter().map(row).collect()
}
