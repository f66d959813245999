//! Conversion of the layers in order.

use std::collections::HashMap;

use opendr_engine::{Error, Result, ResultExt};
use opendr_onnx::{Builder, Dim, ElementType, GraphTensor, Operator};

use super::operator::output;
use super::param::Layer;
use super::product::channels;
use super::weights::Weights;
use crate::tensorflow::ImportOptions;

/// The graph under construction, the converted tensors by name, and the unread weights.
pub struct Trace<'a> {
    pub graph: Builder,
    pub weights: Weights<'a>,
    tensors: HashMap<&'a str, GraphTensor>,
}

impl<'a> Trace<'a> {
    /// Converts all layers.
    ///
    /// # Errors
    /// `Format` and `Unsupported`, with the layer's name.
    pub fn through(
        layers: &[Layer<'a>],
        graph: Builder,
        weights: Weights<'a>,
        options: &ImportOptions,
    ) -> Result<Self> {
        let mut trace = Self { graph, weights, tensors: HashMap::new() };
        for layer in layers {
            let wire = match layer.kind {
                "Input" => trace.open(layer, layers, options),
                _ => output(&mut trace, layer),
            };
            let wire = wire.context(|| format!("layer {} ({})", layer.name, layer.kind))?;
            if layer.outputs.is_empty() || (layer.outputs.len() > 1 && layer.kind != "Split") {
                return Err(Error::format(format!(
                    "layer {} has {} outputs",
                    layer.name,
                    layer.outputs.len()
                )));
            }
            for &name in &layer.outputs {
                if trace.tensors.insert(name, wire.clone()).is_some() {
                    return Err(Error::format(format!("two layers produce {name:?}")));
                }
            }
        }
        trace.weights.end()?;
        Ok(trace)
    }

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

    /// Adds an input of the model: an image, of open size where neither text nor options fix it.
    fn open(
        &mut self,
        layer: &Layer<'a>,
        layers: &[Layer<'a>],
        options: &ImportOptions,
    ) -> Result<GraphTensor> {
        let name = layer.outputs.first().copied().unwrap_or_default();
        let given = |key: i64| layer.parameters.size(key, 0).map(|size| Some(size).filter(|size| *size > 0));
        let (width, height, own) = (given(0)?, given(1)?, given(2)?);
        let size = options.image_size;
        let taken = consumer(layers, name).and_then(channels);
        let dims = vec![
            Some(1),
            own.or(taken),
            height.or(size.map(|size| size.0)),
            width.or(size.map(|size| size.1)),
        ];
        let open = ["", "channels", "height", "width"].map(|axis| format!("{name}_{axis}"));
        let open = [0, 1, 2, 3].map(|axis| open[axis].as_str());
        Ok(self.graph.input(name, ElementType::Float, dims, &open))
    }
}

/// Returns the first layer that processes a tensor.
fn consumer<'l, 'a>(layers: &'l [Layer<'a>], name: &str) -> Option<&'l Layer<'a>> {
    layers.iter().find(|layer| layer.kind != "Input" && layer.inputs.contains(&name))
}
