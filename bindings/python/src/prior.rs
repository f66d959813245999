//! Priors of Python: functions, gains and matrices that policies are trained on top of.

use opendr::control::{Actuator, AxisInput, Lqr, ObservationLqr, ObservationPid, PidGains};
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
    register(Prior::new(name, version, make).about(about)).to_python(py)
}

/// Registers a prior beside those of the toolkit.
fn register(prior: Prior) -> Result<()> {
    // Those of the toolkit are known once its registry is: a name that one of them has is refused here, not at the first use.
    opendr::registry();
    prior.register()
}

/// Limits of the axes, or levels of the only axis.
type ActuatorArguments = (Option<Vec<f64>>, Option<Vec<f64>>);

fn actuator_from_arguments((limits, levels): ActuatorArguments) -> Result<Actuator> {
    match (limits, levels) {
        (Some(limits), None) => Ok(Actuator::Limited(limits)),
        (None, Some(levels)) => Ok(Actuator::Levels(levels)),
        (limits, _) => Err(Error::invalid_param(format!(
            "{} of limit and levels are given; give the limits of a box of actions, or the commands that the choices of a discrete action stand for",
            if limits.is_some() { "both" } else { "neither" }
        ))),
    }
}

/// Gains and input of an axis: kp, ki, kd, filter; place, place of the rate, setpoint.
type AxisArguments = ([f64; 4], usize, Option<usize>, Option<f64>);

/// Makes a PID of numbers of the observation a prior of this process.
#[pyfunction]
pub fn register_pid(
    py: Python<'_>,
    name: String,
    version: u32,
    about: String,
    axes: Vec<AxisArguments>,
    period: f64,
    actuator: ActuatorArguments,
) -> PyResult<()> {
    let make = || {
        let (gains, inputs): (Vec<_>, Vec<_>) = axes
            .into_iter()
            .map(|([kp, ki, kd, filter], place, rate, setpoint)| {
                let gains = PidGains { kp, ki, kd, filter, ..PidGains::default() };
                (gains, AxisInput { place, rate, setpoint })
            })
            .unzip();
        let law = ObservationPid::new(&gains, &inputs, period, actuator_from_arguments(actuator)?)?;
        register(law.into_prior(name, version).about(about))
    };
    make().to_python(py)
}

/// Matrices by rows with their numbers of rows and columns: A, B, Q, R.
type MatrixArguments = [(usize, usize, Vec<f64>); 4];

/// Places of the states in an observation, the state to hold, and the command that holds it.
type PointArguments = (Vec<usize>, Vec<f64>, Vec<f64>);

/// Makes an LQR of numbers of the observation a prior of this process.
#[pyfunction]
pub fn register_lqr(
    py: Python<'_>,
    name: String,
    version: u32,
    about: String,
    matrices: MatrixArguments,
    point: PointArguments,
    actuator: ActuatorArguments,
) -> PyResult<()> {
    let make = || {
        let [(states, _, a), (_, inputs, b), (_, _, q), (_, _, r)] = &matrices;
        for ((name, wanted), (rows, columns, _)) in [
            ("A", [*states, *states]),
            ("B", [*states, *inputs]),
            ("Q", [*states, *states]),
            ("R", [*inputs, *inputs]),
        ]
        .into_iter()
        .zip(&matrices)
        {
            if [*rows, *columns] != wanted {
                let [wanted_rows, wanted_columns] = wanted;
                return Err(Error::invalid_param(format!(
                    "{name} is {rows} x {columns}; for {states} states (rows of A) and {inputs} inputs (columns of B) it is {wanted_rows} x {wanted_columns}"
                )));
            }
        }
        let regulator = Lqr::design(*states, *inputs, a, b, q, r)?;
        let (places, setpoint, trim) = point;
        let law = ObservationLqr::new(regulator, places, setpoint, trim, actuator_from_arguments(actuator)?)?;
        register(law.into_prior(name, version).about(about))
    };
    make().to_python(py)
}

/// Returns name, version and description of every prior.
#[pyfunction]
pub fn priors() -> Vec<(String, u32, String)> {
    let row = |prior: &Prior| {
        let PriorId { name, version } = prior.id().clone();
        (name, version, prior.description().to_owned())
    };
    opendr::priors().iter().map(row).collect()
}
