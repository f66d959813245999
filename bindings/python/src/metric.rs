//! The class `Metric` of Python and the tables of the metrics.

use std::sync::{Mutex, MutexGuard, PoisonError};

use opendr::metrics::{AnyMetric, MetricEntry, find};
use opendr::params::ParamMap;
use opendr::{Error, Task};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::error::ToPython;
use crate::param::params_from_python;
use crate::registry::{field, rows};
use crate::target::target_from_python;

/// A metric with its accumulated samples. Calls from several threads are serialised.
#[pyclass(frozen, module = "opendr._opendr")]
pub struct Metric {
    entry: &'static MetricEntry,
    params: ParamMap,
    state: Mutex<State>,
}

struct State {
    metric: Box<dyn AnyMetric>,
    /// Index of the next sample.
    next: usize,
}

#[pymethods]
impl Metric {
    #[new]
    fn new(py: Python<'_>, name: &str, params: &Bound<'_, PyDict>) -> PyResult<Self> {
        let params = params_from_python(params)?;
        let found = find(name).and_then(|entry| Ok((entry, entry.make(&params)?)));
        let (entry, metric) = found.to_python(py)?;
        Ok(Self { entry, params, state: Mutex::new(State { metric, next: 0 }) })
    }

    /// Adds the prediction for one sample. Returns its score, 0 to 1.
    #[pyo3(signature = (prediction, ground_truth, index=None))]
    fn update(
        &self,
        py: Python<'_>,
        prediction: &Bound<'_, PyAny>,
        ground_truth: &Bound<'_, PyAny>,
        index: Option<usize>,
    ) -> PyResult<f64> {
        let (prediction, ground_truth) = (target_from_python(prediction)?, target_from_python(ground_truth)?);
        let counted = py.detach(|| {
            let mut state = self.lock();
            let index = index.unwrap_or(state.next);
            let score = state.metric.update(index, (&prediction).into(), (&ground_truth).into())?;
            state.next = state.next.max(index + 1);
            Ok(score)
        });
        counted.to_python(py)
    }

    /// Ends the current sequence (video or drive).
    fn end_sequence(&self) {
        self.lock().metric.end_sequence();
    }

    /// Adds the samples of another metric of the same kind, which is empty afterwards.
    fn merge(&self, py: Python<'_>, other: &Self) -> PyResult<()> {
        if std::ptr::eq(self, other) {
            return Err(Error::invalid_input("a metric cannot be merged with itself")).to_python(py);
        }
        let merged = py.detach(|| {
            // The two are never locked at once: two threads that merge two metrics crosswise would deadlock.
            let empty = other.entry.make(&other.params)?;
            let (counted, next) = {
                let mut state = other.lock();
                let next = std::mem::take(&mut state.next);
                (std::mem::replace(&mut state.metric, empty), next)
            };
            let mut state = self.lock();
            state.next = state.next.max(next);
            state.metric.merge(counted)
        });
        merged.to_python(py)
    }

    /// Returns the report as JSON.
    fn finish(&self, py: Python<'_>) -> PyResult<String> {
        let json = py.detach(|| serde_json::to_string(&self.lock().metric.finish()));
        json.map_err(|error| Error::internal("the report has no JSON form").with_source(error)).to_python(py)
    }
}

impl Metric {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Returns the name of a task's metric.
#[pyfunction]
pub fn metric_of(py: Python<'_>, task: &str) -> PyResult<&'static str> {
    task.parse::<Task>().and_then(opendr::evaluation::metric_of).to_python(py)
}

/// Returns a table of each metric.
#[pyfunction]
pub fn metrics(py: Python<'_>) -> PyResult<Bound<'_, PyList>> {
    let tables = opendr::metrics::metrics().iter().map(|entry| {
        let table = PyDict::new(py);
        table.set_item("name", entry.name)?;
        table.set_item("about", entry.about)?;
        table.set_item("prediction", entry.prediction.name())?;
        table.set_item("ground_truth", entry.ground_truth.name())?;
        table.set_item("numbers", entry.numbers.to_vec())?;
        table.set_item("params", rows(py, entry.params, field)?)?;
        Ok(table)
    });
    PyList::new(py, tables.collect::<PyResult<Vec<_>>>()?)
}
