//! A model as it was read: nodes in an order in which each follows its inputs, and constants.

use std::collections::{HashMap, HashSet};
use std::sync::{Arc, Mutex, PoisonError};

use opendr_engine::Result;
use opendr_kernels::{ByteDepthwiseFilters, ByteFilters, DepthwiseFilters, Filters, WinogradFilters};
use opendr_onnx::proto::NodeProto;

use crate::constant::Constants;
use crate::order::ordered;
use crate::tensor::Kind;

/// Packed weights, shared by all plans of a model.
#[derive(Debug, Clone)]
pub(crate) enum Packed {
    Dense(Arc<Filters>),
    Depthwise(Arc<DepthwiseFilters>),
    Winograd(Arc<WinogradFilters>),
    Bytes(Arc<ByteFilters>),
    ByteDepthwise(Arc<ByteDepthwiseFilters>),
}

/// An output of a graph, with what is declared of it.
#[derive(Debug, Clone)]
pub(crate) struct Output {
    pub(crate) name: String,
    pub(crate) kind: Option<Kind>,
    /// Dimensions, `None` where one is open; empty where nothing is declared.
    pub(crate) dims: Vec<Option<usize>>,
}

#[derive(Debug)]
pub(crate) struct Graph {
    pub(crate) nodes: Vec<NodeProto>,
    pub(crate) constants: Constants,
    pub(crate) inputs: Vec<String>,
    /// For each input, whether its elements determine the plan, as those of a list of sizes do.
    pub(crate) by_value: Vec<bool>,
    pub(crate) outputs: Vec<Output>,
    pub(crate) opset: i64,
    /// The branches or the body of each node that has any.
    pub(crate) bodies: Vec<Vec<Arc<Graph>>>,
    /// Nodes that read each tensor.
    pub(crate) readers: HashMap<String, Vec<usize>>,
    /// By node and variant.
    packed: Mutex<HashMap<(usize, u8), Packed>>,
}

/// What a graph is made of.
pub(crate) struct Parts {
    pub(crate) nodes: Vec<NodeProto>,
    pub(crate) constants: Constants,
    pub(crate) inputs: Vec<String>,
    pub(crate) outputs: Vec<Output>,
    pub(crate) opset: i64,
    pub(crate) bodies: Vec<Vec<Arc<Graph>>>,
}

impl Graph {
    /// Creates a graph of nodes in any order.
    ///
    /// # Errors
    /// `Format` where the nodes have a cycle, or read or produce values twice or never.
    pub(crate) fn new(parts: Parts) -> Result<Self> {
        let Parts { nodes, constants, inputs, outputs, opset, bodies } = parts;
        let nodes = ordered(nodes, &constants, &inputs)?;
        let mut readers: HashMap<String, Vec<usize>> = HashMap::new();
        for (index, node) in nodes.iter().enumerate() {
            for input in node.input.iter().filter(|input| !input.is_empty()) {
                readers.entry(input.clone()).or_default().push(index);
            }
        }
        // A graph output counts as a reader.
        for output in &outputs {
            readers.entry(output.name.clone()).or_default().push(usize::MAX);
        }
        let by_value = vec![false; inputs.len()];
        let packed = Mutex::default();
        Ok(Self { nodes, constants, inputs, by_value, outputs, opset, bodies, readers, packed })
    }

    /// Returns the graph of some of the nodes. Its inputs are the tensors that these read and do not produce, and the outputs of
    /// this graph that they do not produce; those of `by_value` determine its plans.
    pub(crate) fn rest(&self, nodes: &[usize], by_value: &HashSet<String>) -> Result<Self> {
        let nodes: Vec<NodeProto> = nodes.iter().filter_map(|&at| self.nodes.get(at)).cloned().collect();
        let produced: HashSet<&String> = nodes.iter().flat_map(|node| &node.output).collect();
        let read = nodes.iter().flat_map(|node| &node.input);
        let read = read.chain(self.outputs.iter().map(|output| &output.name));
        let (mut constants, mut inputs, mut seen) = (Constants::new(), Vec::new(), HashSet::new());
        for name in read.filter(|name| !name.is_empty() && !produced.contains(name)) {
            if !seen.insert(name) {
                continue;
            }
            match self.constants.get(name) {
                Some(constant) => _ = constants.insert(name.clone(), Arc::clone(constant)),
                None => inputs.push(name.clone()),
            }
        }
        let flags = inputs.iter().map(|name| by_value.contains(name)).collect();
        let (outputs, bodies) = (self.outputs.clone(), self.bodies.clone());
        let rest = Self::new(Parts { nodes, constants, inputs, outputs, opset: self.opset, bodies })?;
        Ok(Self { by_value: flags, ..rest })
    }

    /// Returns packed weights, which the first plan makes.
    pub(crate) fn packed(&self, key: (usize, u8), make: impl FnOnce() -> Packed) -> Packed {
        let mut packed = self.packed.lock().unwrap_or_else(PoisonError::into_inner);
        packed.entry(key).or_insert_with(make).clone()
    }

    /// Returns the only node that reads a tensor.
    pub(crate) fn only_reader(&self, tensor: &str) -> Option<usize> {
        match self.readers.get(tensor)?.as_slice() {
            [single] if *single != usize::MAX => Some(*single),
            _ => None,
        }
    }
}
