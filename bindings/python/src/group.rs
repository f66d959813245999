//! Processes that train one network together, connected by a function of Python.

use opendr::learner::TrainingGroup;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::PyBytes;

use crate::error::error_from_exception;

/// A process of a group: its rank, the number of processes, and the function that sends bytes to all and returns those of all.
#[derive(FromPyObject)]
pub struct PythonGroup(usize, usize, Py<PyAny>);

impl TrainingGroup for PythonGroup {
    fn rank(&self) -> usize {
        self.0
    }

    fn size(&self) -> usize {
        self.1
    }

    fn all_gather(&self, payload: Vec<u8>) -> opendr::Result<Vec<Vec<u8>>> {
        Python::attach(|py| {
            let all = self.2.call1(py, (PyBytes::new(py, &payload),));
            let all = all.and_then(|all| all.extract::<Vec<PyBackedBytes>>(py));
            all.map(|all| all.iter().map(|bytes| bytes.to_vec()).collect())
                .map_err(|raised| error_from_exception(py, raised))
        })
    }
}
