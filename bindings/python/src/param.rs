//! Conversion of parameters between Python and the toolkit.

use opendr::params::{ParamMap, ParamValue};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyList, PyString, PyTuple};

/// Maximum depth of nested lists; bounded, since a list may contain itself.
const MAX_DEPTH: usize = 8;

/// Converts a Python object: `None`, bool, int, float, str, a list or tuple of these, or a NumPy number.
pub fn param_from_python(value: &Bound<'_, PyAny>) -> PyResult<ParamValue> {
    param_at_depth(value, 0)
}

fn param_at_depth(value: &Bound<'_, PyAny>, depth: usize) -> PyResult<ParamValue> {
    if value.is_none() {
        return Ok(ParamValue::None);
    }
    if let Ok(flag) = value.cast::<PyBool>() {
        return Ok(ParamValue::Bool(flag.is_true()));
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(ParamValue::Text(text.extract()?));
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        if depth == MAX_DEPTH {
            return Err(PyTypeError::new_err(format!(
                "a parameter has lists nested more than {MAX_DEPTH} deep; give flat lists"
            )));
        }
        let items: PyResult<_> = value.try_iter()?.map(|item| param_at_depth(&item?, depth + 1)).collect();
        return items.map(ParamValue::List);
    }
    if !value.is_instance_of::<PyFloat>()
        && let Ok(number) = value.extract::<i64>()
    {
        return Ok(ParamValue::Int(number));
    }
    let number = value.extract::<f64>();
    number.map(ParamValue::Float).map_err(|_| {
        PyTypeError::new_err(format!("a parameter is a bool, a number, a str or a list of them, not {value}"))
    })
}

/// Converts a Python dictionary to parameters.
pub fn params_from_python(params: &Bound<'_, PyDict>) -> PyResult<ParamMap> {
    params.iter().map(|(name, value)| Ok((name.extract::<String>()?, param_from_python(&value)?))).collect()
}

/// Converts a value to its Python object.
pub fn python_from_param(py: Python<'_>, value: &ParamValue) -> PyResult<Py<PyAny>> {
    match value {
        ParamValue::None => Ok(py.None()),
        ParamValue::Bool(value) => value.into_py_any(py),
        ParamValue::Int(value) => value.into_py_any(py),
        ParamValue::Float(value) => value.into_py_any(py),
        ParamValue::Text(value) => value.into_py_any(py),
        ParamValue::List(values) => {
            let items: PyResult<Vec<_>> = values.iter().map(|value| python_from_param(py, value)).collect();
            items?.into_py_any(py)
        }
    }
}

/// Converts parameters to a Python dictionary.
pub fn python_from_params<'py>(py: Python<'py>, params: &ParamMap) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (name, value) in params {
        dict.set_item(name, python_from_param(py, value)?)?;
    }
    Ok(dict)
}
