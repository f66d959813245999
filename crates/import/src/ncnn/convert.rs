//! Conversion of the layers in order.

use std::collections::HashMap;

use opendr_engine::{Error, Result, ResultExt};
use opendr_onnx::{Builder, ElementType, GraphTensor};

use super::operator::output;
use super::param::Layer;
use super::product::channels;
use super::trace::Trace;
use super::weights::Weights;
use crate::tensorflow::ImportOptions;

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
