//! Equivalents of operators in TensorFlow.

use opendr_engine::Error;
use opendr_onnx::GraphTensor;

use super::model::Node;
use crate::tensorflow::{Attributes, Value};

/// The equivalent of an operator in TensorFlow.
pub struct Step {
    /// TensorFlow's operator; empty where the results are `inputs` themselves.
    pub op: &'static str,
    pub attr: Attributes,
    pub inputs: Vec<Value>,
    /// TensorFlow operator that is applied to the results.
    pub activation: Option<&'static str>,
}

/// Returns the error of a missing input.
pub fn missing(node: &Node, index: usize) -> Error {
    Error::format(format!("it has {} inputs, but input {index} is needed", node.inputs.len()))
}

/// Returns a list of integers.
pub fn list(values: impl IntoIterator<Item = i64>) -> Value {
    Value::plain(GraphTensor::ints(values))
}
