//! Evaluation of functions, pipelines and learners written in Python on a data set.

use opendr::dataset::DatasetIterator;
use opendr::evaluation::{EvalOptions, Predictor, Subject};
use opendr::learner::{Outputs, Port, Ports};
use opendr::metrics::find;
use opendr::{Error, Header, Result, Value, ValueType};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::bar::PythonBar;
use crate::dataset::{GivenDataset, type_of};
use crate::datum::{python_from_value, value_from_python};
use crate::error::{ToPython, error_from_exception};
use crate::report::json_of;

/// Port names of positional inputs.
const POSITIONS: [&str; 8] = ["0", "1", "2", "3", "4", "5", "6", "7"];

/// A predictor that calls a Python function with the data of a sample.
struct Function {
    infer: Py<PyAny>,
    /// Function that resets the state.
    reset: Option<Py<PyAny>>,
    prediction: ValueType,
}

impl Function {
    fn call<'py>(&self, py: Python<'py>, ports: &Ports<'_>) -> PyResult<Bound<'py, PyAny>> {
        let data =
            POSITIONS.iter().map_while(|place| ports.get(place)).map(|value| python_from_value(py, value));
        self.infer.bind(py).call1(PyTuple::new(py, data.collect::<PyResult<Vec<_>>>()?)?)
    }

    /// Returns the first returned value of the prediction's type, else the first returned value.
    fn predict(&self, py: Python<'_>, ports: &Ports<'_>) -> PyResult<Option<Value>> {
        let returned = self.call(py, ports)?;
        let several: Vec<Bound<'_, PyAny>> = match (returned.cast::<PyDict>(), returned.cast::<PyTuple>()) {
            (Ok(by_name), _) => by_name.values().iter().collect(),
            (_, Ok(in_order)) => in_order.iter().collect(),
            _ => vec![returned],
        };
        let matching =
            several.iter().find(|value| type_of(value).is_ok_and(|value_type| value_type == self.prediction));
        let Some(value) = matching.or(several.first()) else { return Ok(None) };
        value_from_python(value, type_of(value)?).map(Some)
    }
}

impl Predictor for Function {
    fn reset(&mut self) {
        let Some(reset) = &self.reset else { return };
        Python::attach(|py| {
            // `reset` cannot return an error; Python reports an exception as unraisable.
            if let Err(raised) = reset.call0(py) {
                raised.write_unraisable(py, Some(reset.bind(py)));
            }
        });
    }

    fn infer(&mut self, ports: &Ports<'_>) -> Result<Outputs> {
        let header = ports.get(POSITIONS[0]).map(|value| value.to_value().header().clone());
        let predicted =
            Python::attach(|py| self.predict(py, ports).map_err(|raised| error_from_exception(py, raised)))?;
        Ok(predicted
            .into_iter()
            .map(|mut value| {
                if *value.header() == Header::default() {
                    value.header_mut().clone_from(header.as_ref().unwrap_or(&Header::default()));
                }
                (value.as_value_ref().value_type().port(), value)
            })
            .collect())
    }
}

/// Evaluates `infer` on a data set by the metric named in `options` (JSON). Returns the outcome as JSON and as text. `types` are the
/// types of its inputs, by default those of the first sample; `classes` are the names of the class indices of its predictions.
#[pyfunction]
#[pyo3(signature = (infer, reset, dataset, types, classes, name, options, verbose))]
#[allow(clippy::too_many_arguments)] // Called from three places in Python, with positional arguments.
pub fn evaluate(
    py: Python<'_>,
    infer: Py<PyAny>,
    reset: Option<Py<PyAny>>,
    dataset: &Bound<'_, PyAny>,
    types: Vec<String>,
    classes: Vec<String>,
    name: String,
    options: &str,
    verbose: bool,
) -> PyResult<(String, String)> {
    let mut options = eval_options_from_json(options).to_python(py)?;
    let metric = options
        .metric
        .as_deref()
        .ok_or_else(|| Error::invalid_param("no metric is given; name one with metric"));
    let metric = metric.and_then(find).to_python(py)?;
    let types = types.iter().map(|name| name.parse()).collect::<Result<Vec<ValueType>>>().to_python(py)?;
    let dataset = GivenDataset::from_python(dataset, &types)?;
    options.name.get_or_insert_with(|| dataset.name());
    let mut function = [Function { infer, reset, prediction: metric.prediction }];
    PythonBar::new(!verbose).run(py, |bar| {
        let job = options.open_by(metric, dataset.as_ref())?;
        let types = if types.is_empty() && !job.dataset.is_empty() { types_of(&job.dataset)? } else { types };
        let ports: Vec<Port> =
            POSITIONS.into_iter().zip(types).map(|(place, value_type)| port(place, value_type)).collect();
        let subject = Subject { learner: name, ..Subject::default() };
        let outcome =
            job.run_pipelines(&mut function, &ports, classes.into_iter().collect(), subject, bar)?;
        Ok((json_of(&outcome)?, outcome.to_string()))
    })
}

/// Reads the options of an evaluation.
///
/// # Errors
/// `InvalidParam` for an unknown option.
pub fn eval_options_from_json(options: &str) -> Result<EvalOptions> {
    serde_json::from_str(options).map_err(|error| {
        Error::invalid_param(format!("invalid arguments of eval: {error}")).with_source(error)
    })
}

fn types_of(dataset: &dyn DatasetIterator) -> Result<Vec<ValueType>> {
    Ok(dataset.get(0)?.data.iter().map(|value| value.as_value_ref().value_type()).collect())
}

fn port(name: &'static str, value_type: ValueType) -> Port {
    Port { name, doc: "", value_type, optional: false, init: false }
}
