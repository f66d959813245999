//! Weights by name.

use std::collections::HashSet;

use opendr_engine::{Error, Result};
use opendr_onnx::FloatType;

/// Maximum size in bytes of a file, and of a table as 32-bit floats.
pub(super) const MAX_BYTES: u64 = 2 << 30;

/// Maximum number of axes of a weight.
const MAX_AXES: usize = 8;

/// A named weight.
#[derive(Debug, Clone, PartialEq)]
pub struct Weight {
    pub(super) name: String,
    pub(super) shape: Vec<usize>,
    pub(super) values: Vec<f32>,
}

impl Weight {
    /// Returns the name, with dots between the parts, e.g. `features.0.weight`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the shape: `[outputs, inputs / groups, height, width]` for a convolution, `[outputs, inputs]` for a linear
    /// layer.
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// Returns the values, row-major.
    pub fn values(&self) -> &[f32] {
        &self.values
    }
}

/// Weights of a file, in one form for all formats: 32-bit floats, PyTorch's layout, names of parameters (`LAYER.weight`,
/// `LAYER.bias`, `LAYER.running_mean`, `LAYER.running_var`).
///
/// Weights of an ONNX model are in the order of its graph, others sorted by name (numbers by their value).
#[derive(Debug, Clone, Default)]
pub struct WeightTable {
    weights: Vec<Weight>,
    names: HashSet<String>,
    numbers: usize,
}

impl WeightTable {
    /// Returns the weights.
    pub fn weights(&self) -> &[Weight] {
        &self.weights
    }

    /// Returns the weight `name`.
    pub fn get(&self, name: &str) -> Option<&Weight> {
        self.weights.iter().find(|weight| weight.name == name)
    }

    /// Returns whether the table contains the weight `name`.
    pub fn has(&self, name: &str) -> bool {
        self.names.contains(name)
    }

    /// Appends a weight.
    ///
    /// # Errors
    /// `Format` when the shape does not match the number of values or the name exists already, `Unsupported` when the table
    /// becomes too large.
    pub fn add(&mut self, name: impl Into<String>, shape: Vec<usize>, values: Vec<f32>) -> Result<()> {
        let name = name.into();
        if opendr_onnx::element_count(&shape) != Some(values.len()) || shape.len() > MAX_AXES {
            return Err(Error::format(format!(
                "weight {name:.80?} has shape {shape:?} but {} values",
                values.len()
            )));
        }
        self.numbers = Self::checked_numbers(self.numbers, values.len(), &name)?;
        if !self.names.insert(name.clone()) {
            return Err(Error::format(format!("the file has two weights {name:.80?}")));
        }
        self.weights.push(Weight { name, shape, values });
        Ok(())
    }

    /// Like [`WeightTable::add`], for values as stored in a file.
    pub(super) fn add_elements(
        &mut self,
        name: String,
        shape: Vec<usize>,
        element: FloatType,
        bytes: &[u8],
    ) -> Result<()> {
        Self::checked_numbers(self.numbers, bytes.len() / element.bytes(), &name)?;
        self.add(name, shape, element.decode(bytes))
    }

    /// Returns the new total when `more` values fit beside `numbers`; to be called before they are read.
    pub(super) fn checked_numbers(numbers: usize, more: usize, name: &str) -> Result<usize> {
        let sum = numbers.checked_add(more).filter(|sum| *sum as u64 * 4 <= MAX_BYTES);
        sum.ok_or_else(|| {
            Error::unsupported(format!(
                "with {name:.80?} of {more} values the weights exceed {} MB",
                MAX_BYTES >> 20
            ))
        })
    }
}
