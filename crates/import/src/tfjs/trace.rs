//! Walks TensorFlow's graph from its outputs and lowers every node that they need, once.

use std::collections::{BTreeMap, HashMap};

use opendr_engine::{Error, Result, ResultExt};

use super::model_json::{Node, producer};
use crate::tensorflow::{Call, ImportOptions, Lowering, Value, input, ops};
use opendr_onnx::{Array, Kind, Wire};

/// Walks TensorFlow's graph from its outputs.
pub struct Trace<'a> {
    nodes: HashMap<&'a str, &'a Node>,
    weights: BTreeMap<String, Array>,
    options: &'a ImportOptions,
    /// The graph written so far.
    pub lowering: Lowering,
    states: HashMap<&'a str, State>,
}

enum State {
    /// On the path from the output that is being traced: meeting it again is a cycle.
    Open,
    Done(Vec<Value>),
}

impl<'a> Trace<'a> {
    /// A trace that has seen nothing yet.
    ///
    /// # Errors
    /// `Format` when two nodes have the same name.
    pub fn new(
        nodes: &'a [Node],
        weights: BTreeMap<String, Array>,
        options: &'a ImportOptions,
    ) -> Result<Self> {
        let mut by_name = HashMap::with_capacity(nodes.len());
        for node in nodes {
            if by_name.insert(node.name.as_str(), node).is_some() {
                return Err(Error::format(format!("two nodes are called {:?}", node.name)));
            }
        }
        Ok(Self { nodes: by_name, weights, options, lowering: Lowering::default(), states: HashMap::new() })
    }

    /// Lowers whatever the tensor `name` needs and returns it. Keeps its own stack, so depth costs no recursion.
    ///
    /// # Errors
    /// `Format` for missing nodes and cycles, and whatever lowering a node gives.
    pub fn tensor(&mut self, name: &str) -> Result<Value> {
        let (output, index) = self.resolve(name)?;
        let mut stack = vec![output];
        while let Some(&node) = stack.last() {
            if matches!(self.states.get(node.name.as_str()), Some(State::Done(_))) {
                stack.pop();
                continue;
            }
            self.states.insert(&node.name, State::Open);
            let mut ready = true;
            for input in data_inputs(node) {
                let (source, _) =
                    self.resolve(input).context(|| format!("importing node {:?}", node.name))?;
                match self.states.get(source.name.as_str()) {
                    Some(State::Done(_)) => {}
                    Some(State::Open) => {
                        return Err(Error::format(format!(
                            "nodes {:?} and {:?} need each other",
                            node.name, source.name
                        )));
                    }
                    None => {
                        stack.push(source);
                        ready = false;
                    }
                }
                if !ready {
                    break;
                }
            }
            if ready {
                let values =
                    self.lower(node).context(|| format!("importing node {:?} ({})", node.name, node.op))?;
                self.states.insert(&node.name, State::Done(values));
                stack.pop();
            }
        }
        self.value(output, index)
    }

    /// The node that a tensor name refers to, and which of its outputs.
    fn resolve(&self, name: &str) -> Result<(&'a Node, usize)> {
        // A node's own name may contain a colon.
        let (node, index) = match self.nodes.get_key_value(name) {
            Some((&node, _)) => (node, Some(0)),
            None => producer(name),
        };
        match (self.nodes.get(node), index) {
            (Some(node), Some(index)) => Ok((node, index)),
            _ => Err(Error::format(format!(
                "tensor {name:?} is needed but no node makes it; get the model.json anew"
            ))),
        }
    }

    fn value(&self, node: &Node, index: usize) -> Result<Value> {
        match self.states.get(node.name.as_str()) {
            Some(State::Done(values)) => values.get(index).cloned(),
            _ => None,
        }
        .ok_or_else(|| Error::format(format!("node {:?} ({}) has no output {index}", node.name, node.op)))
    }

    fn lower(&mut self, node: &'a Node) -> Result<Vec<Value>> {
        match node.op.as_str() {
            "Const" => {
                let array = self.weights.get(&node.name);
                let array = array.ok_or_else(|| Error::format("the manifest has no such weight"))?;
                Ok(vec![Value::plain(Wire::named_constant(&node.name, array.clone()))])
            }
            "Placeholder" | "PlaceholderWithDefault" => Ok(vec![self.input(node)?]),
            op => {
                let lower = ops::lowering(op).ok_or_else(|| {
                    Error::unsupported(format!("operator {op:?} cannot be written as ONNX yet"))
                })?;
                let inputs = data_inputs(node)
                    .map(|input| self.resolve(input).and_then(|(source, index)| self.value(source, index)))
                    .collect::<Result<Vec<Value>>>()?;
                lower(&mut self.lowering, &Call::new(&node.name, &node.op, &node.attr, inputs))
            }
        }
    }

    fn input(&mut self, node: &Node) -> Result<Value> {
        let dims = node.attr.shape("shape").ok_or_else(|| Error::unsupported("input of unknown rank"))?;
        let kind = node.attr.kind("dtype").unwrap_or(Kind::Float);
        Ok(input(&mut self.lowering, self.options, &node.name, kind, dims))
    }
}

/// Inputs that carry data, which control inputs do not.
fn data_inputs(node: &Node) -> impl Iterator<Item = &str> {
    node.input.iter().map(String::as_str).filter(|input| !input.starts_with('^'))
}
