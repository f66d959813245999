//! Reading of a model file.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use opendr_engine::{Error, Result};
use opendr_onnx::passes;
use opendr_onnx::proto::{GraphProto, ModelProto, NodeProto, TypeValue};

use crate::constant::{Constant, Constants};
use crate::declared::{Declared, declared};
use crate::graph::{Graph, Output, Parts};
use crate::ops;
use crate::simplify::simplify;
use crate::subgraphs::{self, MAX_DEPTH};

/// A model: its graph, and what it declares.
#[derive(Debug)]
pub(crate) struct Model {
    pub(crate) graph: Arc<Graph>,
    pub(crate) inputs: Vec<Declared>,
    pub(crate) outputs: Vec<Declared>,
}

impl Model {
    pub(crate) fn read(bytes: &[u8]) -> Result<Self> {
        let ModelProto { opset_import, functions, graph, .. } = opendr_onnx::model_from_bytes(bytes)?;
        let opset = opset_import.iter().filter(|set| set.domain.is_empty() || set.domain == "ai.onnx");
        let opset = opset.map(|set| set.version).max().unwrap_or(17);
        if !functions.is_empty() {
            return Err(Error::unsupported(
                "the executor does not support ONNX models with functions of their own",
            ));
        }
        let graph = graph.unwrap_or_default();
        let named: HashSet<&String> = graph.initializer.iter().map(|tensor| &tensor.name).collect();
        let inputs = declared(graph.input.iter().filter(|input| !named.contains(&input.name)))?;
        let outputs = declared(graph.output.iter())?;
        let formal = inputs.iter().map(|input| input.name.clone()).collect();
        let graph = Reader { opset, outer: &Constants::new(), depth: 0 }.read(graph, formal)?;
        Ok(Self { graph: Arc::new(graph), inputs, outputs })
    }
}

/// Reads a graph within a model.
struct Reader<'a> {
    opset: i64,
    /// Constants of the graphs around it.
    outer: &'a Constants,
    /// Number of the graphs around it.
    depth: usize,
}

impl Reader<'_> {
    /// Reads a graph with these inputs.
    fn read(&self, mut graph: GraphProto, inputs: Vec<String>) -> Result<Graph> {
        if self.depth > MAX_DEPTH {
            return Err(Error::format(format!("the ONNX model nests graphs deeper than {MAX_DEPTH} levels")));
        }
        if !graph.sparse_initializer.is_empty() {
            return Err(Error::unsupported("the executor does not support sparse weights"));
        }
        let refused = |node: &&NodeProto| {
            !(node.domain.is_empty() || node.domain == "ai.onnx") || !ops::is_supported(&node.op_type)
        };
        if let Some(node) = graph.node.iter().find(refused) {
            return Err(Error::unsupported(format!(
                "the executor does not support operator {} {:?}",
                node.op_type, node.name
            )));
        }
        passes::constants_to_initializers(&mut graph);
        // The passes know nothing of branches and bodies: these are taken out of the graph, and what they read becomes inputs of
        // their nodes.
        let mut captured = Constants::new();
        let read = |body: GraphProto, inputs: Vec<String>, outer: &Constants| {
            Reader { opset: self.opset, outer, depth: self.depth + 1 }.read(body, inputs)
        };
        let bodies = subgraphs::take(&mut graph, self.outer, &mut captured, read)?;
        simplify(&mut graph, self.opset)?;
        let mut constants: Constants = HashMap::new();
        for tensor in std::mem::take(&mut graph.initializer) {
            let name = tensor.name.clone();
            let constant = match captured.get(&name) {
                Some(constant) => Arc::clone(constant),
                None => Arc::new(Constant::from_tensor(tensor)?),
            };
            constants.insert(name, constant);
        }
        let outputs: Vec<Output> = outputs(&graph)?;
        let own: HashSet<&String> =
            inputs.iter().chain(graph.node.iter().flat_map(|node| &node.output)).collect();
        let read = graph.node.iter().flat_map(|node| &node.input);
        for name in read.chain(outputs.iter().map(|output| &output.name)) {
            if let Some(constant) = self.outer.get(name).filter(|_| !own.contains(name)) {
                constants.entry(name.clone()).or_insert_with(|| Arc::clone(constant));
            }
        }
        Graph::new(Parts { nodes: graph.node, constants, inputs, outputs, opset: self.opset, bodies })
    }
}

/// Returns the outputs of a graph. Those of a branch need no type.
fn outputs(graph: &GraphProto) -> Result<Vec<Output>> {
    let is_tensor = |value: &TypeValue| matches!(value, TypeValue::Tensor(tensor) if tensor.elem_type != 0);
    let outputs = graph.output.iter().map(|info| {
        let is_declared = info.r#type.as_ref().and_then(|kind| kind.value.as_ref()).is_some_and(is_tensor);
        let declared = if is_declared { declared(std::iter::once(info))?.pop() } else { None };
        let (kind, dims) = declared.map_or((None, Vec::new()), |own| (Some(own.kind), own.dims));
        Ok(Output { name: info.name.clone(), kind, dims })
    });
    outputs.collect()
}
