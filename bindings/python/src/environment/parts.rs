//! Arrays of a space: one for each part of a dictionary or tuple.

use opendr::environment::{Dtype, Space};
use opendr::{Error, Result};
use pyo3::prelude::*;
use pyo3::types::PyList;

use super::shared_array::{Number, SharedArray};

/// Elements of a space as arrays, parts in the order of [`Space`], each with an axis of environments first where there
/// are several.
pub struct Parts {
    parts: Vec<Part>,
    /// Count of numbers of an element.
    row: usize,
}

struct Part {
    /// Index of the part's first number in an element.
    from: usize,
    len: usize,
    array: Py<SharedArray>,
}

impl Parts {
    /// Creates arrays for NumPy to read, each with the element type of its part.
    pub fn of_observations(py: Python<'_>, space: &Space, count: Option<usize>) -> PyResult<Self> {
        Self::new(py, space, count, SharedArray::new)
    }

    /// Creates arrays of float32 for NumPy to write.
    pub fn of_actions(py: Python<'_>, space: &Space, count: Option<usize>) -> PyResult<Self> {
        Self::new(py, space, count, |_, shape| SharedArray::writable(Number::F32, shape))
    }

    fn new(
        py: Python<'_>,
        space: &Space,
        count: Option<usize>,
        make: fn(Number, Vec<usize>) -> Result<SharedArray>,
    ) -> PyResult<Self> {
        let mut leaves = Vec::new();
        collect_leaves(space, &mut leaves).map_err(|error| crate::error::exception(py, &error))?;
        let (mut parts, mut from) = (Vec::new(), 0);
        for (number, shape, len) in leaves {
            let shape = count.into_iter().chain(shape).collect();
            let array = make(number, shape).map_err(|error| crate::error::exception(py, &error))?;
            parts.push(Part { from, len, array: Py::new(py, array)? });
            from += len;
        }
        Ok(Self { parts, row: space.len() })
    }

    /// Returns the arrays, for NumPy.
    pub fn arrays<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        PyList::new(py, self.parts.iter().map(|part| part.array.bind(py)))
    }

    /// Writes consecutive elements into the arrays.
    pub fn write(&self, numbers: &[f32]) {
        for part in &self.parts {
            let array = part.array.get();
            if part.len == self.row {
                array.write(0, numbers);
                continue;
            }
            for (index, element) in numbers.chunks_exact(self.row).enumerate() {
                array.write(index * part.len, &element[part.from..part.from + part.len]);
            }
        }
    }

    /// Reads consecutive elements from the arrays.
    pub fn read(&self, numbers: &mut [f32]) {
        for part in &self.parts {
            let array = part.array.get();
            if part.len == self.row {
                array.read(0, numbers);
                continue;
            }
            for (index, element) in numbers.chunks_exact_mut(self.row).enumerate() {
                array.read(index * part.len, &mut element[part.from..part.from + part.len]);
            }
        }
    }
}

/// Collects the type, shape and count of numbers of every leaf of a space.
fn collect_leaves(space: &Space, leaves: &mut Vec<(Number, Vec<usize>, usize)>) -> Result<()> {
    let (number, shape) = match space {
        Space::Box { shape, dtype, .. } => (number_of_dtype(*dtype)?, shape.clone()),
        Space::Discrete { .. } => (Number::I64, Vec::new()),
        Space::MultiDiscrete(counts) => (Number::I64, vec![counts.len()]),
        Space::MultiBinary(shape) => (Number::I8, shape.clone()),
        Space::Dict(parts) => return parts.values().try_for_each(|part| collect_leaves(part, leaves)),
        Space::Tuple(parts) => return parts.iter().try_for_each(|part| collect_leaves(part, leaves)),
        other => return Err(Error::unsupported(format!("the space {other} cannot be converted to Python"))),
    };
    leaves.push((number, shape, space.len()));
    Ok(())
}

fn number_of_dtype(dtype: Dtype) -> Result<Number> {
    match dtype {
        Dtype::Float32 => Ok(Number::F32),
        Dtype::Float64 => Ok(Number::F64),
        Dtype::Uint8 => Ok(Number::U8),
        Dtype::Int64 => Ok(Number::I64),
        other => {
            Err(Error::unsupported(format!("numbers of type {} cannot be converted to Python", other.name())))
        }
    }
}
