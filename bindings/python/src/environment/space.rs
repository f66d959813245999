//! Spaces as plain Python objects, which `opendr/simulation/_spaces.py` converts to and from Gymnasium's.

use opendr::environment::{Dtype, Space};
use opendr::{Error, Result};
use pyo3::exceptions::{PyLookupError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};

use crate::error::ToPython;

/// Maximum depth of nested spaces; bounded, since a dictionary may contain itself.
const MAX_DEPTH: usize = 16;

/// Converts a space to a dictionary with its `type`; equal bounds become one number.
pub fn python_from_space<'py>(py: Python<'py>, space: &Space) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    match space {
        Space::Box { low, high, shape, dtype } => {
            table.set_item("type", "Box")?;
            table.set_item("low", bounds(py, low)?)?;
            table.set_item("high", bounds(py, high)?)?;
            table.set_item("shape", PyTuple::new(py, shape)?)?;
            table.set_item("dtype", dtype.name())?;
        }
        Space::Discrete { n, start } => {
            table.set_item("type", "Discrete")?;
            table.set_item("n", n)?;
            table.set_item("start", start)?;
        }
        Space::MultiDiscrete(counts) => {
            table.set_item("type", "MultiDiscrete")?;
            table.set_item("nvec", counts)?;
        }
        Space::MultiBinary(shape) => {
            table.set_item("type", "MultiBinary")?;
            table.set_item("shape", PyTuple::new(py, shape)?)?;
        }
        Space::Dict(parts) => {
            let spaces = PyDict::new(py);
            for (name, part) in parts {
                spaces.set_item(name, python_from_space(py, part)?)?;
            }
            table.set_item("type", "Dict")?;
            table.set_item("spaces", spaces)?;
        }
        Space::Tuple(parts) => {
            let spaces: PyResult<Vec<_>> = parts.iter().map(|part| python_from_space(py, part)).collect();
            table.set_item("type", "Tuple")?;
            table.set_item("spaces", PyList::new(py, spaces?)?)?;
        }
        other => {
            return Err(PyValueError::new_err(format!("the space {other} cannot be converted to Python")));
        }
    }
    Ok(table)
}

fn bounds<'py>(py: Python<'py>, bounds: &[f32]) -> PyResult<Bound<'py, PyAny>> {
    match bounds {
        [first, rest @ ..] if rest.iter().all(|bound| bound == first) => {
            Ok(first.into_pyobject(py)?.into_any())
        }
        several => Ok(PyList::new(py, several)?.into_any()),
    }
}

/// Converts a dictionary to a space.
pub fn space_from_python(table: &Bound<'_, PyDict>) -> PyResult<Space> {
    space_at_depth(table, 0)
}

fn space_at_depth(table: &Bound<'_, PyDict>, depth: usize) -> PyResult<Space> {
    if depth == MAX_DEPTH {
        return Err(PyValueError::new_err(format!("spaces are nested more than {MAX_DEPTH} deep")));
    }
    let entry = |name: &str| {
        table.get_item(name)?.ok_or_else(|| PyLookupError::new_err(format!("the space has no {name:?}")))
    };
    let kind: String = entry("type")?.extract()?;
    let space: Result<Space> = match kind.as_str() {
        "Box" => {
            let (low, high, shape): (Vec<f64>, Vec<f64>, Vec<usize>) =
                (entry("low")?.extract()?, entry("high")?.extract()?, entry("shape")?.extract()?);
            let dtype: String = entry("dtype")?.extract()?;
            box_space(&low, &high, shape, &dtype)
        }
        "Discrete" => {
            let (n, start): (i64, i64) = (entry("n")?.extract()?, entry("start")?.extract()?);
            discrete(n, start)
        }
        "MultiDiscrete" => Ok(Space::MultiDiscrete(entry("nvec")?.extract()?)),
        "MultiBinary" => Ok(Space::MultiBinary(entry("shape")?.extract()?)),
        "Dict" => {
            let spaces = entry("spaces")?.cast_into::<PyDict>()?;
            let parts = spaces.iter().map(|(name, part)| {
                Ok((name.extract::<String>()?, space_at_depth(part.cast::<PyDict>()?, depth + 1)?))
            });
            Ok(Space::Dict(parts.collect::<PyResult<_>>()?))
        }
        "Tuple" => {
            let parts = entry("spaces")?.try_iter()?;
            let parts = parts.map(|part| space_at_depth(part?.cast::<PyDict>()?, depth + 1));
            Ok(Space::Tuple(parts.collect::<PyResult<_>>()?))
        }
        other => Err(Error::unsupported(format!("spaces of type {other} are not supported"))),
    };
    space.to_python(table.py())
}

fn box_space(low: &[f64], high: &[f64], shape: Vec<usize>, dtype: &str) -> Result<Space> {
    let dtype = Dtype::from_name(dtype).ok_or_else(|| {
        Error::unsupported(format!("numbers of type {dtype} are not supported; use float32 or uint8"))
    })?;
    let single = |bounds: &[f64]| bounds.iter().map(|bound| *bound as f32).collect();
    Space::bounded(single(low), single(high), shape)?.with_dtype(dtype)
}

fn discrete(n: i64, start: i64) -> Result<Space> {
    match (u32::try_from(n), i32::try_from(start)) {
        // float32 represents integers exactly up to 2^24.
        (Ok(n), Ok(start)) if n > 0 && start.unsigned_abs().saturating_add(n) <= 1 << 24 => {
            Ok(Space::Discrete { n, start })
        }
        _ => Err(Error::unsupported(format!(
            "a discrete space of {n} values from {start} is too large; the maximum is 2^24"
        ))),
    }
}
