//! A model as it was read: nodes in an order in which each follows its inputs, and constants.

use std::collections::{HashMap, HashSet};
use std::sync::{Arc, Mutex, PoisonError};

use opendr_engine::{Error, Result};
use opendr_kernels::{ByteDepthwiseFilters, ByteFilters, DepthwiseFilters, Filters};
use opendr_onnx::passes;
use opendr_onnx::proto::{DimensionValue, GraphProto, NodeProto, TypeValue, ValueInfoProto};

use crate::tensor::{Constant, Kind};

/// A declared input or output.
#[derive(Debug, Clone)]
pub(crate) struct Declared {
    pub(crate) name: String,
    pub(crate) kind: Kind,
    pub(crate) dims: Vec<Option<usize>>,
}

/// Packed weights, shared by all plans of a model.
#[derive(Debug, Clone)]
pub(crate) enum Packed {
    Dense(Arc<Filters>),
    Depthwise(Arc<DepthwiseFilters>),
    Bytes(Arc<ByteFilters>),
    ByteDepthwise(Arc<ByteDepthwiseFilters>),
}

#[derive(Debug)]
pub(crate) struct Graph {
    pub(crate) nodes: Vec<NodeProto>,
    pub(crate) constants: HashMap<String, Arc<Constant>>,
    pub(crate) inputs: Vec<Declared>,
    pub(crate) outputs: Vec<Declared>,
    pub(crate) opset: i64,
    /// Nodes that read each tensor.
    pub(crate) readers: HashMap<String, Vec<usize>>,
    /// By node and variant.
    packed: Mutex<HashMap<(usize, u8), Packed>>,
}

impl Graph {
    pub(crate) fn read(bytes: &[u8], is_supported: impl Fn(&str) -> bool) -> Result<Self> {
        let model = opendr_onnx::model_from_bytes(bytes)?;
        let opset = model.opset_import.iter().filter(|set| set.domain.is_empty() || set.domain == "ai.onnx");
        let opset = opset.map(|set| set.version).max().unwrap_or(17);
        if !model.functions.is_empty() {
            return Err(Error::unsupported(
                "the executor does not support ONNX models with functions of their own",
            ));
        }
        let mut graph = model.graph.unwrap_or_default();
        if !graph.sparse_initializer.is_empty() {
            return Err(Error::unsupported("the executor does not support sparse weights"));
        }
        let refused = |node: &&NodeProto| {
            !(node.domain.is_empty() || node.domain == "ai.onnx") || !is_supported(&node.op_type)
        };
        if let Some(node) = graph.node.iter().find(refused) {
            return Err(Error::unsupported(format!(
                "the executor does not support operator {} {:?}",
                node.op_type, node.name
            )));
        }
        let named: HashSet<String> = graph.initializer.iter().map(|tensor| tensor.name.clone()).collect();
        let inputs = declared(graph.input.iter().filter(|input| !named.contains(&input.name)))?;
        let outputs = declared(graph.output.iter())?;
        simplify(&mut graph, opset)?;
        let mut constants = HashMap::new();
        for tensor in std::mem::take(&mut graph.initializer) {
            constants.insert(tensor.name.clone(), Arc::new(Constant::from_tensor(&tensor)?));
        }
        let nodes = ordered(graph.node, &constants, &inputs)?;
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
        Ok(Self { nodes, constants, inputs, outputs, opset, readers, packed: Mutex::default() })
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

/// Runs the passes that need no shapes. They know operators of opset 11 and later.
fn simplify(graph: &mut GraphProto, opset: i64) -> Result<()> {
    passes::constants_to_initializers(graph);
    widen_half_constants(graph)?;
    if opset >= 11 {
        passes::simplify(graph);
    } else {
        passes::remove_identities(graph);
        passes::fold_affine_into_conv(graph);
        passes::remove_dead_nodes(graph);
    }
    Ok(())
}

/// Evaluates casts of 16-bit weights, so that passes see constants.
fn widen_half_constants(graph: &mut GraphProto) -> Result<()> {
    let by_name: HashMap<&str, usize> =
        graph.initializer.iter().enumerate().map(|(i, tensor)| (tensor.name.as_str(), i)).collect();
    let mut widened = Vec::new();
    for (index, node) in graph.node.iter().enumerate() {
        let ([input], [output], "Cast", 1) =
            (node.input.as_slice(), node.output.as_slice(), node.op_type.as_str(), node.int_or("to", 0))
        else {
            continue;
        };
        let Some(tensor) = by_name.get(input.as_str()).and_then(|&i| graph.initializer.get(i)) else {
            continue;
        };
        let constant = Constant::from_tensor(tensor)?;
        if constant.kind != Kind::F16 {
            continue;
        }
        let halves = constant.data.get::<u16>(constant.region());
        let raw_data =
            halves.iter().flat_map(|&half| opendr_onnx::float_from_half(half).to_le_bytes()).collect();
        let mut tensor = tensor.clone();
        tensor.name.clone_from(output);
        tensor.data_type = 1;
        tensor.int32_data.clear();
        tensor.raw_data = raw_data;
        widened.push((index, tensor));
    }
    let gone: HashSet<usize> = widened.iter().map(|(index, _)| *index).collect();
    let mut index = 0;
    graph.node.retain(|_| {
        index += 1;
        !gone.contains(&(index - 1))
    });
    graph.initializer.extend(widened.into_iter().map(|(_, tensor)| tensor));
    let read: HashSet<&str> = graph.node.iter().flat_map(|node| &node.input).map(String::as_str).collect();
    let outputs: HashSet<&str> = graph.output.iter().map(|output| output.name.as_str()).collect();
    graph
        .initializer
        .retain(|tensor| read.contains(tensor.name.as_str()) || outputs.contains(tensor.name.as_str()));
    Ok(())
}

fn declared<'a>(infos: impl Iterator<Item = &'a ValueInfoProto>) -> Result<Vec<Declared>> {
    infos
        .map(|info| {
            let name = info.name.clone();
            let Some(TypeValue::Tensor(tensor)) = info.r#type.as_ref().and_then(|kind| kind.value.as_ref())
            else {
                return Err(Error::unsupported(format!("{name:?} of the ONNX model is not a tensor")));
            };
            let kind = Kind::from_onnx(tensor.elem_type, &name)?;
            if kind == Kind::F16 {
                return Err(Error::unsupported(format!("{name:?} of the ONNX model has 16-bit floats")));
            }
            let dims = tensor.shape.iter().flat_map(|shape| &shape.dim);
            let dims = dims.map(|dim| match &dim.value {
                Some(DimensionValue::Value(size)) => usize::try_from(*size).ok(),
                _ => None,
            });
            Ok(Declared { name, kind, dims: dims.collect() })
        })
        .collect()
}

/// Orders nodes so that each follows the producers of its inputs.
fn ordered(
    nodes: Vec<NodeProto>,
    constants: &HashMap<String, Arc<Constant>>,
    inputs: &[Declared],
) -> Result<Vec<NodeProto>> {
    let mut known: HashSet<String> = constants.keys().cloned().collect();
    known.extend(inputs.iter().map(|input| input.name.clone()));
    let mut produced: HashMap<&str, usize> = HashMap::new();
    for (index, node) in nodes.iter().enumerate() {
        for output in node.output.iter().filter(|output| !output.is_empty()) {
            if known.contains(output) || produced.insert(output, index).is_some() {
                return Err(Error::format(format!(
                    "damaged ONNX model: the value {output:?} is produced twice"
                )));
            }
        }
    }
    let mut waiting = vec![0_usize; nodes.len()];
    let mut followers: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
    for (index, node) in nodes.iter().enumerate() {
        for input in node.input.iter().filter(|input| !input.is_empty() && !known.contains(*input)) {
            let Some(&producer) = produced.get(input.as_str()) else {
                return Err(Error::format(format!(
                    "damaged ONNX model: nothing produces the value {input:?}"
                )));
            };
            waiting[index] += 1;
            followers[producer].push(index);
        }
    }
    // The lowest node that can run comes first: the order of the file where that is one.
    let mut ready: std::collections::BTreeSet<usize> =
        (0..nodes.len()).filter(|&index| waiting[index] == 0).collect();
    let mut order = Vec::with_capacity(nodes.len());
    while let Some(index) = ready.pop_first() {
        order.push(index);
        for &follower in &followers[index] {
            waiting[follower] -= 1;
            if waiting[follower] == 0 {
                ready.insert(follower);
            }
        }
    }
    if order.len() < nodes.len() {
        return Err(Error::format("damaged ONNX model: its graph has a cycle"));
    }
    let mut nodes: Vec<Option<NodeProto>> = nodes.into_iter().map(Some).collect();
    Ok(order.into_iter().filter_map(|index| nodes.get_mut(index).and_then(Option::take)).collect())
}
