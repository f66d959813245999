//! The tables of the learners, from which Python builds classes, signatures, docstrings and stubs.

use opendr::learner::{Capabilities, Entry, Output, Port, Spec};
use opendr::params::{Field, ParamKind, ParamRange};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::param::python_from_param;

/// Returns the table of every learner, in order of registration.
#[pyfunction]
pub fn entries(py: Python<'_>) -> PyResult<Bound<'_, PyList>> {
    let tables: PyResult<Vec<_>> =
        opendr::registry().entries().iter().map(|entry| table(py, entry)).collect();
    PyList::new(py, tables?)
}

fn table<'py>(py: Python<'py>, entry: &Entry) -> PyResult<Bound<'py, PyDict>> {
    let Spec { name, task, class, about, without_effect, recognises_network } = entry.spec;
    let Capabilities { fit, fit_in, streaming } = entry.capabilities;
    let table = PyDict::new(py);
    table.set_item("name", name)?;
    table.set_item("task", task.name())?;
    table.set_item("package", task.package())?;
    table.set_item("class_name", class)?;
    table.set_item("about", about)?;
    // A parameter of OpenDR has an effect if this build has a parameter of its name.
    let fields = || entry.params.iter().chain(entry.fit_params);
    let has = |name: &str| fields().any(|field| field.name == name || field.aliases.contains(&name));
    let idle: Vec<_> = without_effect.iter().filter(|(name, _)| !has(name)).copied().collect();
    table.set_item("without_effect", idle)?;
    table.set_item("params", rows(py, entry.params, field)?)?;
    table.set_item("fit_params", rows(py, entry.fit_params, field)?)?;
    table.set_item("ports", rows(py, entry.ports, port)?)?;
    table.set_item("outputs", rows(py, entry.outputs, output)?)?;
    table.set_item("stateful", entry.stateful)?;
    table.set_item("fit", fit)?;
    table.set_item("fit_in", fit_in)?;
    table.set_item("streaming", streaming)?;
    table.set_item("recognises_networks", recognises_network.is_some())?;
    Ok(table)
}

/// Returns a dictionary for each of `rows`.
pub fn rows<'py, T>(
    py: Python<'py>,
    rows: &[T],
    row: fn(&Bound<'py, PyDict>, &T) -> PyResult<()>,
) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let dict = |item| {
        let dict = PyDict::new(py);
        row(&dict, item).map(|()| dict)
    };
    rows.iter().map(dict).collect()
}

/// Writes the description of a parameter into `row`.
pub fn field(row: &Bound<'_, PyDict>, field: &Field) -> PyResult<()> {
    let kind = match field.kind {
        ParamKind::Float => "float",
        ParamKind::Int => "int",
        ParamKind::Bool => "bool",
        ParamKind::Text => "text",
        ParamKind::List => "list",
    };
    row.set_item("name", field.name)?;
    row.set_item("doc", field.doc)?;
    row.set_item("kind", kind)?;
    row.set_item("optional", field.optional)?;
    row.set_item("choices", field.choices.to_vec())?;
    row.set_item("range", field.range.map(|ParamRange { low, high }| (low, high)))?;
    row.set_item("unit", field.unit)?;
    row.set_item("live", field.live)?;
    row.set_item("aliases", field.aliases.to_vec())?;
    row.set_item("former", field.former.to_vec())?;
    row.set_item("default", python_from_param(row.py(), &field.default.value())?)
}

fn port(row: &Bound<'_, PyDict>, port: &Port) -> PyResult<()> {
    row.set_item("name", port.name)?;
    row.set_item("doc", port.doc)?;
    row.set_item("type", port.value_type.name())?;
    row.set_item("optional", port.optional)?;
    row.set_item("init", port.init)
}

fn output(row: &Bound<'_, PyDict>, output: &Output) -> PyResult<()> {
    row.set_item("name", output.name)?;
    row.set_item("doc", output.doc)?;
    row.set_item("type", output.value_type.name())
}
