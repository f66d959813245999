//! A node of a TensorFlow graph with the values of its inputs.

use opendr_engine::{Error, Result};

use super::attributes::Attributes;
use super::value::Value;
use opendr_onnx::Array;

/// A node with the values of its inputs, and the checks that lowerings share.
pub struct Call<'a> {
    name: &'a str,
    op: &'a str,
    attr: &'a Attributes,
    inputs: Vec<Value>,
}

impl<'a> Call<'a> {
    /// Creates the node `name` with TensorFlow's operator `op`; inputs in order, without control inputs.
    pub fn new(name: &'a str, op: &'a str, attr: &'a Attributes, inputs: Vec<Value>) -> Self {
        Self { name, op, attr, inputs }
    }

    /// Returns the node's name, from which the names of its tensors are derived.
    pub fn name(&self) -> &'a str {
        self.name
    }

    /// Returns TensorFlow's name of the operator.
    pub fn op(&self) -> &'a str {
        self.op
    }

    /// Returns the parameters.
    pub fn attr(&self) -> &'a Attributes {
        self.attr
    }

    /// Returns all inputs.
    pub fn inputs(&self) -> &[Value] {
        &self.inputs
    }

    /// Returns a required input.
    ///
    /// # Errors
    /// `Format` when it is missing.
    pub fn input(&self, index: usize) -> Result<&Value> {
        self.inputs.get(index).ok_or_else(|| {
            Error::format(format!("it has {} inputs, but input {index} is needed", self.inputs.len()))
        })
    }

    /// Returns an input whose elements must be known at import.
    ///
    /// # Errors
    /// `Unsupported` when they depend on the model's inputs.
    pub fn constant(&self, index: usize) -> Result<&Array> {
        self.input(index)?.array().ok_or_else(|| {
            Error::unsupported(format!("input {index} is computed by the model, but must be a constant"))
        })
    }

    /// Returns known integers: a shape, a list of axes, a scalar.
    ///
    /// # Errors
    /// Those of [`Call::constant`]; `Format` when they are not integers.
    pub fn ints(&self, index: usize) -> Result<&[i64]> {
        let array = self.constant(index)?;
        array.as_ints().ok_or_else(|| Error::format(format!("input {index} must be integers")))
    }

    /// Returns a known integer.
    ///
    /// # Errors
    /// Those of [`Call::ints`].
    pub fn int(&self, index: usize) -> Result<i64> {
        match self.ints(index)? {
            [single] => Ok(*single),
            other => Err(Error::format(format!("input {index} must be one integer, not {}", other.len()))),
        }
    }

    /// Returns known axes of a tensor of `rank` axes, negative ones counted from the end; sorted, without duplicates.
    ///
    /// # Errors
    /// Those of [`Call::ints`]; `Format` when an axis does not exist.
    pub fn axes(&self, index: usize, rank: usize) -> Result<Vec<usize>> {
        let mut axes: Vec<usize> =
            self.ints(index)?.iter().map(|&axis| axis_in(axis, rank)).collect::<Result<_>>()?;
        axes.sort_unstable();
        axes.dedup();
        Ok(axes)
    }
}

/// Resolves an axis; a negative one counts from the end.
///
/// # Errors
/// `Format` when a tensor of `rank` axes has no such axis.
pub fn axis_in(axis: i64, rank: usize) -> Result<usize> {
    let absolute = if axis < 0 { axis.saturating_add(rank as i64) } else { axis };
    usize::try_from(absolute)
        .ok()
        .filter(|&axis| axis < rank)
        .ok_or_else(|| Error::format(format!("axis {axis} is out of range for a tensor of rank {rank}")))
}
