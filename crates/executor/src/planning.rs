//! Building of the steps of a graph, and of what has to wait for the elements of a run.

use std::collections::HashSet;

use opendr_engine::{Error, ErrorKind, Result};
use opendr_kernels::Compute;
use opendr_onnx::proto::NodeProto;

use crate::constant::Given;
use crate::graph::Graph;
use crate::ops::{self, Operator};
use crate::planner::Planner;
use crate::subgraphs;
use crate::value::{Id, Source};

/// The steps of a graph, and the values that they compute.
pub(crate) struct Planned<'a> {
    pub(crate) planner: Planner<'a>,
    pub(crate) outputs: Vec<Id>,
    /// `None` where the outputs are those of the graph.
    pub(crate) cut: Option<Cut>,
}

/// Where a graph is cut: what comes after it needs the elements of tensors that come before it.
#[derive(Debug)]
pub(crate) struct Cut {
    /// Names of the tensors that are read after it.
    pub(crate) names: Vec<String>,
    /// Nodes that run on these tensors at once.
    pub(crate) hosts: Vec<usize>,
    /// The other nodes after it.
    pub(crate) later: Vec<usize>,
    /// Names of the tensors whose elements determine the plans of these nodes.
    pub(crate) by_value: HashSet<String>,
}

/// Nodes that cannot be planned.
#[derive(Default)]
struct Waiting {
    hosts: Vec<usize>,
    later: Vec<usize>,
    /// Their outputs.
    names: HashSet<String>,
    /// Tensors whose elements they need.
    by_value: HashSet<String>,
}

impl Waiting {
    fn is_empty(&self) -> bool {
        self.names.is_empty() && self.hosts.is_empty() && self.later.is_empty()
    }
}

/// Builds the steps of all nodes that can be planned.
pub(crate) fn planned<'a>(graph: &'a Graph, compute: &'a Compute, given: &[Given]) -> Result<Planned<'a>> {
    let mut planner = Planner::new(graph, compute, given)?;
    let waiting = plan_nodes(&mut planner)?;
    if waiting.is_empty() {
        let outputs = outputs(&mut planner)?;
        return Ok(Planned { planner, outputs, cut: None });
    }
    let Waiting { hosts, later, names: unknown, mut by_value } = waiting;
    let (mut names, mut outputs, mut seen) = (Vec::new(), Vec::new(), HashSet::new());
    let nodes = hosts.iter().chain(&later).filter_map(|&index| graph.nodes.get(index));
    let read = nodes.flat_map(|node| &node.input).chain(graph.outputs.iter().map(|output| &output.name));
    for name in read.filter(|name| !name.is_empty() && !unknown.contains(*name)) {
        if !seen.insert(name) {
            continue;
        }
        materialise(&mut planner, name)?;
        let Some(id) = planner.named(name) else { return Err(unproduced(name)) };
        if planner.is_constant(id) {
            by_value.insert(name.clone());
        }
        outputs.push(planner.plain(id)?);
        names.push(name.clone());
    }
    Ok(Planned { planner, outputs, cut: Some(Cut { names, hosts, later, by_value }) })
}

/// Returns the outputs of the graph.
fn outputs(planner: &mut Planner<'_>) -> Result<Vec<Id>> {
    let mut outputs = Vec::new();
    for output in &planner.graph.outputs {
        materialise(planner, &output.name)?;
        let id = planner.named(&output.name).ok_or_else(|| unproduced(&output.name))?;
        let kind = planner.kind(id);
        if let Some(declared) = output.kind.filter(|&declared| declared != kind) {
            return Err(Error::format(format!(
                "damaged ONNX model: the output {:?} is declared as {declared:?}, but is {kind:?}",
                output.name
            )));
        }
        outputs.push(planner.plain(id)?);
    }
    Ok(outputs)
}

fn unproduced(name: &str) -> Error {
    Error::format(format!("damaged ONNX model: nothing produces the value {name:?}"))
}

/// Builds the steps of the nodes of the planner's graph, as far as they can be planned.
fn plan_nodes(planner: &mut Planner<'_>) -> Result<Waiting> {
    let graph = planner.graph;
    let mut waiting = Waiting::default();
    for (index, node) in graph.nodes.iter().enumerate() {
        if planner.is_fused(index) {
            continue;
        }
        planner.begin(index);
        let depends = node.input.iter().any(|name| waiting.names.contains(name));
        if !depends && node.op_type == "DequantizeLinear" && planner.defer(index) {
            continue;
        }
        let steps = if depends { Steps::Later(Vec::new()) } else { steps(planner, index)? };
        match steps {
            Steps::Built(outputs) => {
                for (name, id) in node.output.iter().zip(outputs) {
                    planner.name(name, id);
                }
                continue;
            }
            Steps::Host => waiting.hosts.push(index),
            Steps::Later(by_value) => {
                waiting.later.push(index);
                waiting.by_value.extend(by_value);
            }
        }
        waiting.names.extend(node.output.iter().filter(|name| !name.is_empty()).cloned());
    }
    Ok(waiting)
}

/// What became of a node.
enum Steps {
    Built(Vec<Id>),
    /// It runs on the tensors that the steps have computed.
    Host,
    /// It is planned when the elements of these tensors are known.
    Later(Vec<String>),
}

fn steps(planner: &mut Planner<'_>, index: usize) -> Result<Steps> {
    let node = &planner.graph.nodes[index];
    match ops::operator(&node.op_type) {
        Some(Operator::Host(host)) => {
            let inputs = inputs(planner, index)?;
            if !inputs.iter().flatten().all(|&id| planner.is_constant(id)) {
                return Ok(Steps::Host);
            }
            let mut constants = Vec::new();
            for id in inputs {
                constants.push(match id {
                    Some(id) => Some(planner.known(node, id)?),
                    None => None,
                });
            }
            let outputs = host(node, &constants.iter().map(Option::as_deref).collect::<Vec<_>>())?;
            return Ok(Steps::Built(
                outputs.into_iter().map(|output| planner.add_constant(output)).collect(),
            ));
        }
        Some(Operator::If) => return Ok(branch(planner, index)?.map_or(Steps::Host, Steps::Built)),
        Some(Operator::Loop) => return Ok(Steps::Host),
        Some(Operator::Steps(_)) | None => {}
    }
    let built = match ops::build_on_bytes(planner, node) {
        Ok(None) => build(planner, index),
        Ok(Some(outputs)) => Ok(outputs),
        Err(error) => Err(error),
    };
    match built {
        Ok(outputs) => Ok(Steps::Built(outputs)),
        Err(error) => match planner.take_missing().as_slice() {
            [] => Err(error),
            missing => Ok(Steps::Later(needed(planner, node, missing))),
        },
    }
}

/// Plans a branch whose condition is known as a part of the graph; `None` where a part of it has to wait.
fn branch(planner: &mut Planner<'_>, index: usize) -> Result<Option<Vec<Id>>> {
    let graph = planner.graph;
    let node = &graph.nodes[index];
    let inputs = inputs(planner, index)?;
    let condition = inputs.first().copied().flatten().and_then(|id| planner.constant(id));
    let Some(condition) = condition else { return Ok(None) };
    let (_, branches) = subgraphs::bodies(graph, node)?;
    let Some(taken) = branches.get(usize::from(!condition.truth(node)?)) else { return Ok(None) };
    let inputs = inputs.get(1..).unwrap_or_default();
    let planned = planner.within(taken, inputs, |planner| {
        if plan_nodes(planner)?.is_empty() { outputs(planner).map(Some) } else { Ok(None) }
    });
    match planned {
        // The elements of a run may be all that is missing.
        Err(error) if error.kind() == ErrorKind::Unsupported => Ok(None),
        planned => planned,
    }
}

/// Returns the names of the inputs whose elements determine the steps of a node: those that were missing, and other short lists of
/// integers.
fn needed(planner: &Planner<'_>, node: &NodeProto, missing: &[Id]) -> Vec<String> {
    const SHORT: usize = 64;
    let unknown = || {
        let named = node.input.iter().enumerate();
        named
            .filter_map(|(slot, name)| Some((slot, name, planner.named(name)?)))
            .filter(|&(_, _, id)| !planner.is_constant(id))
    };
    let is_missing = |id: Id| missing.iter().any(|&other| same(planner, id, other));
    let mut names: Vec<String> =
        unknown().filter(|&(_, _, id)| is_missing(id)).map(|(_, name, _)| name.clone()).collect();
    if names.is_empty() {
        return unknown().map(|(_, name, _)| name.clone()).collect();
    }
    let is_list = |slot: usize, id: Id| {
        slot > 0 && planner.kind(id).is_index() && planner.shape(id).iter().product::<usize>() <= SHORT
    };
    names.extend(unknown().filter(|&(slot, _, id)| is_list(slot, id)).map(|(_, name, _)| name.clone()));
    names
}

/// Returns whether two values are the same, perhaps in different layouts.
fn same(planner: &Planner<'_>, a: Id, b: Id) -> bool {
    let place = |id: Id| match planner.value(id).source {
        Source::Constant(_) => None,
        Source::Input(index) => Some((true, index, 0)),
        Source::Buffer(buffer, offset) => Some((false, buffer, offset)),
    };
    a == b || planner.value(a).other == Some(b) || place(a).is_some() && place(a) == place(b)
}

/// Returns the values of the inputs of a node as they are.
fn inputs(planner: &mut Planner<'_>, index: usize) -> Result<Vec<Option<Id>>> {
    let node = &planner.graph.nodes[index];
    for name in &node.input {
        materialise(planner, name)?;
    }
    planner.begin(index);
    Ok(node.input.iter().map(|name| planner.named(name)).collect())
}

/// Builds the steps of a node whose inputs are read as they are.
fn build(planner: &mut Planner<'_>, index: usize) -> Result<Vec<Id>> {
    let inputs = inputs(planner, index)?;
    ops::build(planner, &planner.graph.nodes[index], &inputs)
}

/// Dequantises a value that has been deferred.
fn materialise(planner: &mut Planner<'_>, name: &str) -> Result<()> {
    let Some(index) = planner.take_deferred(name) else { return Ok(()) };
    planner.begin(index);
    let node = &planner.graph.nodes[index];
    // The inputs of a deferred node are not deferred.
    let inputs: Vec<Option<Id>> = node.input.iter().map(|name| planner.named(name)).collect();
    for (name, id) in node.output.iter().zip(ops::build(planner, node, &inputs)?) {
        planner.name(name, id);
    }
    Ok(())
}
