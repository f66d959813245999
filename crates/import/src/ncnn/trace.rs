//! The graph under construction.

use std::collections::HashMap;

use opendr_engine::{Error, Result};
use opendr_onnx::{Builder, Dim, ElementType, GraphTensor, Operator};

use super::param::Layer;
use super::weights::Weights;

/// The graph under construction, the converted tensors by name, and the unread weights.
pub struct Trace<'a> {
    pub graph: Builder,
    pub weights: Weights<'a>,
    pub(super) tensors: HashMap<&'a str, GraphTensor>,
}

impl<'a> Trace<'a> {
    /// Returns a tensor by name.
    ///
    /// # Errors
    /// `Format` when no layer has produced it.
    pub fn tensor(&self, name: &str) -> Result<GraphTensor> {
        self.tensors
            .get(name)
            .cloned()
            .ok_or_else(|| Error::format(format!("no preceding layer produces {name:?}")))
    }

    /// Returns an input of a layer.
    ///
    /// # Errors
    /// `Format` when the layer has no such input.
    pub fn input(&self, layer: &Layer<'_>, index: usize) -> Result<GraphTensor> {
        let few =
            || Error::format(format!("it has {} inputs, but input {index} is needed", layer.inputs.len()));
        self.tensor(layer.inputs.get(index).ok_or_else(few)?)
    }

    /// Adds an operator on floats.
    ///
    /// # Errors
    /// `Format` when the graph exceeds the maximum number of nodes.
    pub fn add(
        &mut self,
        layer: &Layer<'_>,
        operator: Operator,
        inputs: &[&GraphTensor],
        dims: Vec<Dim>,
    ) -> Result<GraphTensor> {
        self.graph.add(layer.name, operator, inputs, ElementType::Float, dims)
    }

    /// Adds an operator whose output has the dimensions of its first input.
    ///
    /// # Errors
    /// Those of [`Trace::add`].
    pub fn same(
        &mut self,
        layer: &Layer<'_>,
        operator: Operator,
        inputs: &[&GraphTensor],
    ) -> Result<GraphTensor> {
        let dims = inputs.first().map(|input| input.dims().to_vec()).unwrap_or_default();
        self.add(layer, operator, inputs, dims)
    }
}
