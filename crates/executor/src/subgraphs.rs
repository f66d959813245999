//! Branches and bodies of loops: graphs within nodes.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use opendr_engine::{Error, Result};
use opendr_onnx::proto::{AttributeProto, GraphProto, NodeProto, TensorProto, TypeValue};

use crate::attributes::Attributes;
use crate::constant::{Constant, Constants};
use crate::graph::Graph;

/// Maximum nesting depth of graphs.
pub(crate) const MAX_DEPTH: usize = 16;

/// Attribute that names the branches or the body of a node by their index.
const BODIES: &str = "opendr.bodies";

/// Attribute with the number of values that each iteration of a loop hands to the next.
pub(crate) const STATES: &str = "opendr.states";

/// Returns the branches or the body of a node.
pub(crate) fn bodies<'a>(graph: &'a Graph, node: &NodeProto) -> Result<(usize, &'a [Arc<Graph>])> {
    let index = usize::try_from(node.int_or(BODIES, -1)).ok();
    let found = index.and_then(|index| Some((index, graph.bodies.get(index)?.as_slice())));
    found.ok_or_else(|| node.damaged("it has no graph"))
}

/// Takes the graphs out of the nodes, and reads them with `read`. What they read of the graph around them becomes an input of the node and of
/// the graph, behind the others; constants of the graph and of those around it (`outer`) they have themselves, and
/// `captured` has them too.
pub(crate) fn take(
    graph: &mut GraphProto,
    outer: &Constants,
    captured: &mut Constants,
    read: impl Fn(GraphProto, Vec<String>, &Constants) -> Result<Graph>,
) -> Result<Vec<Vec<Arc<Graph>>>> {
    let (mut nodes, mut all) = (std::mem::take(&mut graph.node), Vec::new());
    let initializers: HashMap<&str, &TensorProto> =
        graph.initializer.iter().map(|tensor| (tensor.name.as_str(), tensor)).collect();
    for node in &mut nodes {
        node.attribute.retain(|attribute| attribute.name != BODIES && attribute.name != STATES);
        let keys: &[&str] = match node.op_type.as_str() {
            "If" => &["then_branch", "else_branch"],
            "Loop" => &["body"],
            _ => continue,
        };
        let mut graphs = Vec::new();
        for key in keys {
            let attribute = node.attribute.iter_mut().find(|attribute| attribute.name == **key);
            let body = attribute.and_then(|attribute| attribute.g.take());
            graphs.push(body.ok_or_else(|| node.damaged(&format!("attribute {key:?} must be a graph")))?);
        }
        let mut names = Vec::new();
        for name in graphs.iter().flat_map(|body| free_names(body, 0)) {
            if let Some(tensor) = initializers.get(name.as_str()) {
                if let Entry::Vacant(free) = captured.entry(name) {
                    free.insert(Arc::new(Constant::from_tensor((*tensor).clone())?));
                }
            } else if let Some(constant) = outer.get(&name) {
                captured.insert(name, Arc::clone(constant));
            } else if !names.contains(&name) {
                names.push(name);
            }
        }
        let formal = if node.op_type == "Loop" {
            node.input.resize(node.input.len().max(2), String::new());
            node.input.len()
        } else {
            0
        };
        let mut own = Vec::new();
        for body in graphs {
            let mut inputs = inputs(&body)?;
            if inputs.len() != formal {
                return Err(node.damaged("its inputs are not those of its graph"));
            }
            inputs.extend(names.iter().cloned());
            own.push(Arc::new(read(body, inputs, captured)?));
        }
        node.input.append(&mut names);
        for (name, value) in [(BODIES, all.len()), (STATES, formal.saturating_sub(2))] {
            let i = i64::try_from(value).unwrap_or(-1);
            node.attribute.push(AttributeProto { name: name.to_owned(), i, ..AttributeProto::default() });
        }
        all.push(own);
    }
    graph.node = nodes;
    Ok(all)
}

/// Returns the names of the inputs of a body.
fn inputs(graph: &GraphProto) -> Result<Vec<String>> {
    let inputs =
        graph.input.iter().map(|info| match info.r#type.as_ref().and_then(|kind| kind.value.as_ref()) {
            None | Some(TypeValue::Tensor(_)) => Ok(info.name.clone()),
            Some(_) => Err(Error::unsupported(format!("{:?} of the ONNX model is not a tensor", info.name))),
        });
    inputs.collect()
}

/// Returns the names that a graph reads and does not define, each once; those of graphs that are nested too deep are left out.
fn free_names(graph: &GraphProto, depth: usize) -> Vec<String> {
    if depth > MAX_DEPTH {
        return Vec::new();
    }
    let own = graph.input.iter().map(|info| &info.name);
    let own = own.chain(graph.initializer.iter().map(|tensor| &tensor.name));
    let own: HashSet<&String> = own.chain(graph.node.iter().flat_map(|node| &node.output)).collect();
    let (mut free, mut seen) = (Vec::new(), HashSet::new());
    let mut add = |name: &String| {
        if !name.is_empty() && !own.contains(name) && seen.insert(name.clone()) {
            free.push(name.clone());
        }
    };
    for node in &graph.node {
        node.input.iter().for_each(&mut add);
        let nested = node.attribute.iter().flat_map(|attribute| attribute.g.iter().chain(&attribute.graphs));
        nested.for_each(|nested| free_names(nested, depth + 1).iter().for_each(&mut add));
    }
    graph.output.iter().for_each(|output| add(&output.name));
    free
}
