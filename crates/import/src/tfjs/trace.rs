//! Traversal of a TensorFlow graph from its outputs; every required node is lowered once.

use std::collections::{BTreeMap, HashMap};

use opendr_engine::{Error, Result, ResultExt};

use super::model_json::{Node, producer};
use crate::tensorflow::{Call, ImportOptions, Lowering, Value, input, ops};
use opendr_onnx::{Array, ElementType, GraphTensor};

/// The traversal of a TensorFlow graph from its outputs.
pub struct Trace<'a> {
    nodes: HashMap<&'a str, &'a Node>,
    weights: BTreeMap<String, Array>,
    options: &'a ImportOptions,
    /// The graph under construction.
    pub lowering: Lowering,
    states: HashMap<&'a str, State>,
}

enum State {
    /// On the path from the current output: visiting it again is a cycle.
    Open,
    Done(Vec<Value>),
}

impl<'a> Trace<'a> {
    /// Creates a traversal without visited nodes.
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
                return Err(Error::format(format!("two nodes have the name {:?}", node.name)));
            }
        }
        Ok(Self { nodes: by_name, weights, options, lowering: Lowering::default(), states: HashMap::new() })
    }

    /// Lowers the nodes that the tensor `name` needs and returns the tensor. Uses an explicit stack, so that depth
    /// costs no recursion.
    ///
    /// # Errors
    /// `Format` for missing nodes and cycles, and the errors of lowering a node.
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
                            "nodes {:?} and {:?} form a cycle",
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

    /// Returns the node that a tensor name refers to, and the output index.
    fn resolve(&self, name: &str) -> Result<(&'a Node, usize)> {
        // A node's own name may contain a colon.
        let (node, index) = match self.nodes.get_key_value(name) {
            Some((&node, _)) => (node, Some(0)),
            None => producer(name),
        };
        match (self.nodes.get(node), index) {
            (Some(node), Some(index)) => Ok((node, index)),
            _ => Err(Error::format(format!(
                "tensor {name:?} is needed, but no node produces it; download the model.json again"
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
                Ok(vec![Value::plain(GraphTensor::named_constant(&node.name, array.clone()))])
            }
            "Placeholder" | "PlaceholderWithDefault" => Ok(vec![self.input(node)?]),
            op => {
                let lower = ops::lowering(op)
                    .ok_or_else(|| Error::unsupported(format!("operator {op:?} is not supported")))?;
                let inputs = data_inputs(node)
                    .map(|input| self.resolve(input).and_then(|(source, index)| self.value(source, index)))
                    .collect::<Result<Vec<Value>>>()?;
                lower(&mut self.lowering, &Call::new(&node.name, &node.op, &node.attr, inputs))
            }
        }
    }

    fn input(&mut self, node: &Node) -> Result<Value> {
        let dims = node
            .attr
            .shape("shape")
            .ok_or_else(|| Error::unsupported("an input of unknown rank is not supported"))?;
        let kind = node.attr.kind("dtype").unwrap_or(ElementType::Float);
        Ok(input(&mut self.lowering, self.options, &node.name, kind, dims))
    }
}

/// Returns the data inputs of a node, without control inputs.
fn data_inputs(node: &Node) -> impl Iterator<Item = &str> {
    node.input.iter().map(String::as_str).filter(|input| !input.starts_with('^'))
}
