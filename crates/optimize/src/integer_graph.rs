//! Construction of the INT8 graph: every quantised tensor passes through `QuantizeLinear` and `DequantizeLinear`,
//! weights and biases come from `DequantizeLinear`, and the runtime fuses these with the node between them into an
//! integer operator. A runtime without this fusion computes the same in floats.

use std::collections::{HashMap, HashSet};

use opendr_engine::{Error, Result};
use opendr_onnx::passes::remove_dead_nodes;
use opendr_onnx::proto::{DataType, GraphProto, NodeProto, TensorProto};
use opendr_onnx::{Array, Operator};

use crate::plan::{Layer, Plan};
use crate::range::Range;
use crate::weights::ByteWeights;

/// Maximum of a quantised bias, in steps.
const LARGEST_BIAS: f32 = (1_u32 << 30) as f32;

/// Suffix of the names of quantised tensors.
pub const ROUNDED: &str = "/rounded";

/// Returns the graph with the layers of `plan` in INT8; `ranges` contains the range of each tensor by name.
///
/// # Errors
/// `Internal` when a range is missing.
pub fn integer_graph(
    graph: &GraphProto,
    plan: &Plan,
    ranges: &HashMap<String, Range>,
    weight_bits: u32,
) -> Result<GraphProto> {
    let mut writer = Writer::new(graph, ranges);
    let mut layers = plan.layers.iter().filter(|layer| !layer.is_float).peekable();
    let becomes_bytes: HashMap<&str, &str> =
        plan.tensors.iter().map(|(tensor, range)| (tensor.as_str(), range.as_str())).collect();
    for input in &graph.input {
        if let Some(range) = becomes_bytes.get(input.name.as_str()) {
            writer.round(&input.name, range)?;
        }
    }
    for (index, node) in graph.node.iter().enumerate() {
        let mut rewritten = node.clone();
        for input in &mut rewritten.input {
            if let Some(rounded) = writer.rounded.get(input.as_str()) {
                *input = rounded.clone();
            }
        }
        if let Some(layer) = layers.next_if(|layer| layer.node == index) {
            let data = node.input.first().and_then(|input| becomes_bytes.get(input.as_str()));
            let range = writer.range(data.copied().unwrap_or_default())?;
            writer.use_bytes(layer, &mut rewritten, range, weight_bits)?;
        }
        writer.nodes.push(rewritten);
        for output in &node.output {
            if let Some(range) = becomes_bytes.get(output.as_str()) {
                writer.round(output, range)?;
            }
        }
    }
    let mut written = GraphProto {
        node: writer.nodes,
        initializer: writer.initializers,
        value_info: Vec::new(),
        ..graph.clone()
    };
    remove_dead_nodes(&mut written);
    Ok(written)
}

struct Writer<'a> {
    nodes: Vec<NodeProto>,
    initializers: Vec<TensorProto>,
    names: HashSet<String>,
    ranges: &'a HashMap<String, Range>,
    /// Quantised tensors and their replacements.
    rounded: HashMap<String, String>,
    /// Added initializers by content; layers may share weights.
    constants: HashMap<(i32, Vec<i64>, Vec<u8>), String>,
    /// Names of scale and zero point of each range.
    parameters: HashMap<&'a str, [String; 2]>,
}

impl<'a> Writer<'a> {
    fn new(graph: &GraphProto, ranges: &'a HashMap<String, Range>) -> Self {
        let made = graph.node.iter().flat_map(|node| &node.output).cloned();
        let given = graph.input.iter().map(|input| input.name.clone());
        let constant = graph.initializer.iter().map(|tensor| tensor.name.clone());
        Self {
            nodes: Vec::new(),
            initializers: graph.initializer.clone(),
            names: made.chain(given).chain(constant).collect(),
            ranges,
            rounded: HashMap::new(),
            constants: HashMap::new(),
            parameters: HashMap::new(),
        }
    }

    fn unique(&mut self, name: String) -> String {
        let mut unique = name.clone();
        for count in 2.. {
            if self.names.insert(unique.clone()) {
                break;
            }
            unique = format!("{name}_{count}");
        }
        unique
    }

    fn range(&self, tensor: &str) -> Result<Range> {
        let missing = || Error::internal(format!("the range of {tensor:?} is unknown"));
        self.ranges.get(tensor).copied().ok_or_else(missing)
    }

    fn add(&mut self, op: &'static str, axis: Option<usize>, input: Vec<String>, output: &str) {
        let operator = Operator::new(op);
        let operator = axis.map_or(operator.clone(), |axis| operator.int("axis", axis as i64));
        self.nodes.push(NodeProto {
            op_type: op.to_owned(),
            name: output.to_owned(),
            input,
            output: vec![output.to_owned()],
            attribute: operator.attributes().to_vec(),
            ..NodeProto::default()
        });
    }

    fn constant(&mut self, hint: String, mut tensor: TensorProto) -> String {
        let content = (tensor.data_type, tensor.dims.clone(), tensor.raw_data.clone());
        if let Some(name) = self.constants.get(&content) {
            return name.clone();
        }
        let name = self.unique(hint);
        tensor.name.clone_from(&name);
        self.initializers.push(tensor);
        self.constants.insert(content, name.clone());
        name
    }

    /// Quantises and dequantises a tensor.
    fn round(&mut self, tensor: &str, range_of: &str) -> Result<()> {
        let range = self.range(range_of)?;
        let key = self.ranges.get_key_value(range_of).map_or("", |(name, _)| name.as_str());
        let parameters = match self.parameters.get(key) {
            Some(parameters) => parameters.clone(),
            None => {
                let scale =
                    self.constant(format!("{range_of}/scale"), Array::scalar(range.scale).to_tensor("")?);
                let zero = bytes_tensor(Vec::new(), vec![range.zero_point], DataType::Uint8);
                let parameters = [scale, self.constant(format!("{range_of}/zero"), zero)];
                self.parameters.insert(key, parameters.clone());
                parameters
            }
        };
        let [bytes, rounded] =
            [self.unique(format!("{tensor}/bytes")), self.unique(format!("{tensor}{ROUNDED}"))];
        let with = |input: &str| [&[input.to_owned()], &parameters[..]].concat();
        self.add("QuantizeLinear", None, with(tensor), &bytes);
        self.add("DequantizeLinear", None, with(&bytes), &rounded);
        self.rounded.insert(tensor.to_owned(), rounded);
        Ok(())
    }

    /// Quantises the weights and the bias of a layer.
    fn use_bytes(&mut self, layer: &Layer, node: &mut NodeProto, input: Range, bits: u32) -> Result<()> {
        let channels = layer.weights.dims().get(layer.axis).copied().unwrap_or_default();
        let bias = self.bias(node).filter(|bias| bias.len() == channels);
        let least = |channel: usize| {
            let bias = bias.as_ref().and_then(|bias| bias.get(channel)).copied().unwrap_or_default();
            bias.abs() / (input.scale * LARGEST_BIAS)
        };
        let broken = || Error::internal(format!("the weights of {:?} cannot be read", layer.name));
        let weights = ByteWeights::new(&layer.weights, layer.axis, bits, least).ok_or_else(broken)?;
        let name = layer.name.as_str();
        let scales = Array::new(vec![channels], opendr_onnx::Data::Float(weights.scales.clone()));
        let scales = scales.ok_or_else(broken)?.to_tensor("")?;
        let zeros = bytes_tensor(vec![channels as i64], vec![0; channels], DataType::Int8);
        let inputs = vec![
            self.constant(format!("{name}/weights/bytes"), weights.to_tensor("")),
            self.constant(format!("{name}/weights/scale"), scales),
            self.constant(format!("{name}/weights/zero"), zeros),
        ];
        let rounded = self.unique(format!("{name}/weights{ROUNDED}"));
        self.add("DequantizeLinear", Some(weights.axis()), inputs, &rounded);
        if let Some(slot) = node.input.get_mut(1) {
            *slot = rounded;
        }
        if let (Some(bias), Some(slot)) = (bias, node.input.get_mut(2)) {
            *slot = self.whole_bias(name, &bias, &weights.scales, input)?;
        }
        Ok(())
    }

    /// Quantises a bias in steps of the product of both scales, so that it is added before scaling.
    fn whole_bias(&mut self, layer: &str, bias: &[f32], scales: &[f32], input: Range) -> Result<String> {
        let scales: Vec<f32> = scales.iter().map(|scale| scale * input.scale).collect();
        let steps = bias.iter().zip(&scales).map(|(bias, scale)| (bias / scale).round_ties_even() as i32);
        let raw = steps.flat_map(i32::to_le_bytes).collect();
        let dims = vec![bias.len() as i64];
        let steps = bytes_tensor(dims, raw, DataType::Int32);
        let scales = Array::new(vec![bias.len()], opendr_onnx::Data::Float(scales))
            .ok_or_else(|| Error::internal("the length of the bias does not match the layer"))?;
        let inputs = vec![
            self.constant(format!("{layer}/bias/steps"), steps),
            self.constant(format!("{layer}/bias/scale"), scales.to_tensor("")?),
        ];
        let rounded = self.unique(format!("{layer}/bias{ROUNDED}"));
        self.add("DequantizeLinear", Some(0), inputs, &rounded);
        Ok(rounded)
    }

    fn bias(&self, node: &NodeProto) -> Option<Vec<f32>> {
        let name = node.input.get(2).filter(|name| !name.is_empty())?;
        let tensor = self.initializers.iter().find(|tensor| tensor.name == *name)?;
        Array::from_tensor(tensor).filter(|bias| bias.dims().len() == 1)?.as_floats().map(<[f32]>::to_vec)
    }
}

fn bytes_tensor(dims: Vec<i64>, raw_data: Vec<u8>, data_type: DataType) -> TensorProto {
    TensorProto { dims, raw_data, data_type: data_type as i32, ..TensorProto::default() }
}
