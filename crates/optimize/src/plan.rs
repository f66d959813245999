//! Selection of the nodes that compute in INT8, and of the tensors to quantise.

use std::collections::{HashMap, HashSet};

use opendr_onnx::Array;
use opendr_onnx::proto::{GraphProto, NodeProto};

/// Operators that pass values unchanged, so that input and output share a range.
const PASSING: [&str; 11] = [
    "DepthToSpace",
    "Flatten",
    "MaxPool",
    "Reshape",
    "Resize",
    "Slice",
    "SpaceToDepth",
    "Split",
    "Squeeze",
    "Transpose",
    "Unsqueeze",
];

/// Operators with an INT8 kernel, used when all their inputs are quantised.
const FOLLOWING: [&str; 11] = [
    "Add",
    "AveragePool",
    "Clip",
    "Concat",
    "GlobalAveragePool",
    "HardSigmoid",
    "LeakyRelu",
    "Mul",
    "Relu",
    "Sigmoid",
    "Softmax",
];

/// A node with weights.
#[derive(Debug, Clone)]
pub struct Layer {
    /// Index among the nodes.
    pub node: usize,
    /// Name of its output.
    pub name: String,
    pub op: String,
    /// Dimensions and elements of its weights.
    pub weights: Array,
    /// Output axis of the weights.
    pub axis: usize,
    /// Whether it stays in floats.
    pub is_float: bool,
}

/// The layers of a graph and the tensors to quantise.
#[derive(Debug)]
pub struct Plan {
    pub layers: Vec<Layer>,
    /// Tensors to quantise, in the order of the nodes, with the tensor whose range each uses.
    pub tensors: Vec<(String, String)>,
}

/// Returns the nodes of a graph that have weights.
pub fn layers(graph: &GraphProto) -> Vec<Layer> {
    let constants: HashMap<&str, _> =
        graph.initializer.iter().map(|tensor| (tensor.name.as_str(), tensor)).collect();
    let layer = |(index, node): (usize, &NodeProto)| {
        let weights = Array::from_tensor(constants.get(node.input.get(1)?.as_str())?)?;
        let data = node.input.first()?;
        let axis = axis_of_outputs(node, weights.dims())?;
        let plain = weights.as_floats().is_some() && !constants.contains_key(data.as_str());
        plain.then(|| Layer {
            node: index,
            name: node.output.first().cloned().unwrap_or_default(),
            op: node.op_type.clone(),
            weights,
            axis,
            is_float: false,
        })
    };
    graph.node.iter().enumerate().filter_map(layer).collect()
}

fn axis_of_outputs(node: &NodeProto, dims: &[usize]) -> Option<usize> {
    let is_one = |key: &str| node.find(key).is_none_or(|attribute| attribute.f == 1.0);
    match (node.op_type.as_str(), dims.len()) {
        _ if !node.domain.is_empty() || dims.contains(&0) => None,
        ("Conv", 3..=5) => Some(0),
        ("Gemm", 2) if is_one("alpha") && is_one("beta") && node.int_or("transA", 0) == 0 => {
            Some(if node.int_or("transB", 0) == 0 { 1 } else { 0 })
        }
        ("MatMul", 2) => Some(1),
        _ => None,
    }
}

impl Plan {
    /// Creates the plan for `layers`, of which some stay in floats.
    pub fn new(graph: &GraphProto, layers: Vec<Layer>) -> Self {
        let constants: HashSet<&str> = graph.initializer.iter().map(|tensor| tensor.name.as_str()).collect();
        let given_out: HashSet<&str> = graph.output.iter().map(|output| output.name.as_str()).collect();
        let mut plan = Self { layers, tensors: Vec::new() };
        let mut ranges: HashMap<&str, &str> = HashMap::new();
        let integer: HashSet<usize> =
            plan.layers.iter().filter(|layer| !layer.is_float).map(|layer| layer.node).collect();
        for (index, node) in graph.node.iter().enumerate() {
            let data = data_inputs(node);
            let is_layer = integer.contains(&index);
            let follows = follows(node)
                && !data.is_empty()
                && data.iter().all(|name| ranges.contains_key(name) && !constants.contains(name));
            if !is_layer && !follows {
                continue;
            }
            if is_layer && let Some(input) = data.first() {
                plan.add(&mut ranges, input, input);
            }
            if feeds_rectifier(graph, node) {
                // The output range of the rectifier is sufficient.
                if let Some(output) = node.output.first() {
                    ranges.insert(output, output);
                }
                continue;
            }
            let source = data.first().and_then(|name| ranges.get(name).copied());
            for output in node.output.iter().filter(|output| !given_out.contains(output.as_str())) {
                let passing = PASSING.contains(&node.op_type.as_str());
                plan.add(&mut ranges, output, source.filter(|_| passing).unwrap_or(output));
            }
        }
        plan
    }

    fn add<'a>(&mut self, ranges: &mut HashMap<&'a str, &'a str>, tensor: &'a str, range: &'a str) {
        if ranges.insert(tensor, range).is_none() {
            self.tensors.push((tensor.to_owned(), range.to_owned()));
        }
    }

    /// Returns the tensors whose values must be observed.
    pub fn observed_tensors(&self) -> Vec<String> {
        let own = self.tensors.iter().filter(|(tensor, range)| tensor == range);
        own.map(|(tensor, _)| tensor.clone()).collect()
    }
}

/// Returns the inputs that contain values, not sizes or limits.
fn data_inputs(node: &NodeProto) -> Vec<&str> {
    let count = match node.op_type.as_str() {
        "Add" | "Concat" | "Mul" => usize::MAX,
        _ => 1,
    };
    node.input.iter().take(count).map(String::as_str).collect()
}

fn follows(node: &NodeProto) -> bool {
    let op = node.op_type.as_str();
    let stays_within = op != "Resize" || node.find("mode").is_none_or(|mode| mode.s != b"cubic");
    node.domain.is_empty() && (PASSING.contains(&op) || FOLLOWING.contains(&op)) && stays_within
}

/// Returns whether the output of a layer is read by a single rectifier, which saturation of the bytes replaces.
fn feeds_rectifier(graph: &GraphProto, node: &NodeProto) -> bool {
    let [output] = node.output.as_slice() else { return false };
    let mut readers = graph.node.iter().filter(|reader| reader.input.contains(output));
    let is_rectifier = |reader: &NodeProto| matches!(reader.op_type.as_str(), "Relu" | "Clip");
    matches!((readers.next(), readers.next()), (Some(reader), None) if is_rectifier(reader))
        && !graph.output.iter().any(|given| given.name == *output)
}
