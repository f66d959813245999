//! Initialisers of an ONNX model, named by the layer that uses them.

use std::collections::HashMap;

use opendr_engine::{Error, Result};
use opendr_onnx::model_from_bytes;
use opendr_onnx::proto::{GraphProto, NodeProto};

use crate::weights::WeightTable;

mod constants;

use constants::{Constant, Constants, attribute};

/// Returns the weights in the order of the graph's nodes, under their initialiser's name without `.weight`: convolutions,
/// linear layers (also a product followed by a sum), batch normalisations, slopes and recurrent layers. Quantised integers are
/// dequantised to floats.
pub(super) fn table_from_onnx(bytes: &[u8]) -> Result<WeightTable> {
    let graph = model_from_bytes(bytes)?.graph.unwrap_or_default();
    let mut walk =
        Walk { constants: Constants::of(&graph)?, table: WeightTable::default(), open: HashMap::new() };
    walk.nodes(&graph)?;
    match walk.table.weights() {
        [] => Err(Error::format("the ONNX model has no weights; check that it is a network")),
        _ => Ok(walk.table),
    }
}

struct Walk<'g> {
    constants: Constants<'g>,
    table: WeightTable,
    /// Outputs of layers without a bias, which a following sum may add.
    open: HashMap<&'g str, Open>,
}

struct Open {
    layer: String,
    outputs: usize,
    /// Number of axes after that of the outputs.
    behind: usize,
}

impl<'g> Walk<'g> {
    fn nodes(&mut self, graph: &'g GraphProto) -> Result<()> {
        for node in &graph.node {
            match node.op_type.as_str() {
                "Conv" => self.kernel(node, 0, |_| {})?,
                "ConvTranspose" => self.kernel(node, 1, |_| {})?,
                "Gemm" => {
                    let plain = attribute(node, "transB").is_none_or(|transposed| transposed.i == 0);
                    let scale = attribute(node, "alpha").map_or(1.0, |alpha| alpha.f);
                    self.kernel(node, 0, |kernel| {
                        if plain {
                            kernel.transpose();
                        }
                        kernel.values.iter_mut().for_each(|number| *number *= scale);
                    })?;
                }
                "MatMul" => self.kernel(node, 0, Constant::transpose)?,
                "Add" => self.sum(node)?,
                "BatchNormalization" => self.norm(node)?,
                "PRelu" | "GRU" | "LSTM" | "RNN" | "LayerNormalization" | "InstanceNormalization" => {
                    for input in node.input.iter().skip(1) {
                        if let Some(constant) = self.constant(input)? {
                            let name = constant.name.clone();
                            self.add(name, constant)?;
                        }
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Returns a constant that fits into the table.
    fn constant(&self, name: &str) -> Result<Option<Constant>> {
        match self.constants.count(name) {
            Some(count) => {
                WeightTable::checked_numbers(0, count, name)?;
                self.constants.get(name)
            }
            None => Ok(None),
        }
    }

    /// Adds a weight; a weight shared by layers is added once.
    fn add(&mut self, name: String, constant: Constant) -> Result<()> {
        if self.table.has(&name) {
            return Ok(());
        }
        self.table.add(name, constant.shape, constant.values)
    }

    /// Adds a layer with its kernel as second input, outputs along `axis`, and an optional bias as third input.
    fn kernel(&mut self, node: &'g NodeProto, axis: usize, change: impl FnOnce(&mut Constant)) -> Result<()> {
        let Some(input) = node.input.get(1) else { return Ok(()) };
        let Some(mut kernel) = self.constant(input)?.filter(|kernel| kernel.shape.len() >= 2) else {
            return Ok(());
        };
        change(&mut kernel);
        let layer = kernel.name.strip_suffix(".weight").unwrap_or(&kernel.name).to_owned();
        let (outputs, behind) = (kernel.shape[axis], kernel.shape.len() - 2);
        self.add(format!("{layer}.weight"), kernel)?;
        let bias = node.input.get(2).map(|input| self.constant(input)).transpose()?.flatten();
        match (bias, node.output.first()) {
            (Some(bias), _) => {
                let values = bias.values;
                let bias = Constant { shape: vec![values.len()], values, name: bias.name };
                self.add(format!("{layer}.bias"), bias)
            }
            (None, Some(output)) => {
                self.open.insert(output, Open { layer, outputs, behind });
                Ok(())
            }
            (None, None) => Ok(()),
        }
    }

    /// Adds the bias of the layer before a sum.
    fn sum(&mut self, node: &NodeProto) -> Result<()> {
        let [a, b] = &node.input[..] else { return Ok(()) };
        for (layer, bias) in [(a, b), (b, a)] {
            if !self.open.contains_key(layer.as_str()) {
                continue;
            }
            let Some(bias) = self.constant(bias)? else { continue };
            let fits = |open: &Open| {
                let [outputs, behind] = [open.outputs, open.behind];
                let mut axes = bias.shape.iter().rev();
                axes.by_ref().take(behind).all(|side| *side == 1)
                    && axes.next() == Some(&outputs)
                    && bias.values.len() == outputs
            };
            if self.open.get(layer.as_str()).is_some_and(fits)
                && let Some(Open { layer, outputs, .. }) = self.open.remove(layer.as_str())
            {
                return self.add(format!("{layer}.bias"), Constant { shape: vec![outputs], ..bias });
            }
        }
        Ok(())
    }

    fn norm(&mut self, node: &NodeProto) -> Result<()> {
        let mut parts = Vec::new();
        for input in node.input.iter().skip(1).take(4) {
            match self.constant(input)? {
                Some(part) => parts.push(part),
                None => return Ok(()),
            }
        }
        let Some(name) = parts.first().map(|scale| scale.name.clone()) else { return Ok(()) };
        let layer = name.strip_suffix(".weight").unwrap_or(&name);
        for (part, field) in parts.into_iter().zip(["weight", "bias", "running_mean", "running_var"]) {
            self.add(format!("{layer}.{field}"), part)?;
        }
        Ok(())
    }
}
