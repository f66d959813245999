//! One node of TensorFlow's graph with the values of its inputs.

use opendr_engine::{Error, Result};

use super::attributes::Attributes;
use super::value::Value;
use opendr_onnx::Array;

/// One node with the values of its inputs, and the checks that every lowering needs.
pub struct Call<'a> {
    name: &'a str,
    op: &'a str,
    attr: &'a Attributes,
    inputs: Vec<Value>,
}

impl<'a> Call<'a> {
    /// The node `name`, which is TensorFlow's operator `op`; inputs in its order, control inputs left out.
    pub fn new(name: &'a str, op: &'a str, attr: &'a Attributes, inputs: Vec<Value>) -> Self {
        Self { name, op, attr, inputs }
    }

    /// Name of the node; the tensors written for it are called after it.
    pub fn name(&self) -> &'a str {
        self.name
    }

    /// TensorFlow's name of the operator.
    pub fn op(&self) -> &'a str {
        self.op
    }

    /// Parameters.
    pub fn attr(&self) -> &'a Attributes {
        self.attr
    }

    /// All inputs.
    pub fn inputs(&self) -> &[Value] {
        &self.inputs
    }

    /// An input that must be there.
    ///
    /// # Errors
    /// `Format` when it is not.
    pub fn input(&self, index: usize) -> Result<&Value> {
        self.inputs.get(index).ok_or_else(|| {
            Error::format(format!("has {} inputs but input {index} is needed", self.inputs.len()))
        })
    }

    /// An input whose elements must be known when importing.
    ///
    /// # Errors
    /// `Unsupported` when they depend on what the model is fed.
    pub fn constant(&self, index: usize) -> Result<&Array> {
        self.input(index)?.array().ok_or_else(|| {
            Error::unsupported(format!(
                "input {index} is computed by the model but must be known when importing"
            ))
        })
    }

    /// Known integers: a shape, a list of axes, a scalar.
    ///
    /// # Errors
    /// As [`Call::constant`]; `Format` when they are no integers.
    pub fn ints(&self, index: usize) -> Result<&[i64]> {
        let array = self.constant(index)?;
        array.as_ints().ok_or_else(|| Error::format(format!("input {index} should be integers")))
    }

    /// A known integer.
    ///
    /// # Errors
    /// As [`Call::ints`].
    pub fn int(&self, index: usize) -> Result<i64> {
        match self.ints(index)? {
            [single] => Ok(*single),
            other => Err(Error::format(format!("input {index} should be one integer, not {}", other.len()))),
        }
    }

    /// Known axes of a tensor of `rank` axes, negative ones counted from the end; sorted, each once.
    ///
    /// # Errors
    /// As [`Call::ints`]; `Format` when an axis does not exist.
    pub fn axes(&self, index: usize, rank: usize) -> Result<Vec<usize>> {
        let mut axes: Vec<usize> =
            self.ints(index)?.iter().map(|&axis| axis_in(axis, rank)).collect::<Result<_>>()?;
        axes.sort_unstable();
        axes.dedup();
        Ok(axes)
    }
}

/// A negative axis counts from the end.
///
/// # Errors
/// `Format` when a tensor of `rank` axes has no such axis.
pub fn axis_in(axis: i64, rank: usize) -> Result<usize> {
    let absolute = if axis < 0 { axis.saturating_add(rank as i64) } else { axis };
    usize::try_from(absolute)
        .ok()
        .filter(|&axis| axis < rank)
        .ok_or_else(|| Error::format(format!("axis {axis} of a tensor of rank {rank}")))
}
