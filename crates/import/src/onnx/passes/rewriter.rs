//! A graph opened for rewriting.

use std::collections::{HashMap, HashSet};

use crate::onnx::array::Array;
use crate::onnx::proto::{GraphProto, NodeProto};

/// A graph with an index of who makes and who reads each tensor, and the means to change it. Every change costs time
/// in proportion to what it changes, not to the graph. Nodes are only marked as removed until [`Rewriter::finish`].
pub struct Rewriter<'a> {
    graph: &'a mut GraphProto,
    producers: HashMap<String, usize>,
    readers: HashMap<String, Vec<usize>>,
    initializers: HashMap<String, usize>,
    given_out: HashSet<String>,
    removed: HashSet<usize>,
}

impl<'a> Rewriter<'a> {
    /// Indexes the graph.
    pub fn new(graph: &'a mut GraphProto) -> Self {
        let mut producers = HashMap::new();
        let mut readers: HashMap<String, Vec<usize>> = HashMap::new();
        for (index, node) in graph.node.iter().enumerate() {
            producers.extend(node.output.iter().map(|output| (output.clone(), index)));
            for input in node.input.iter().filter(|input| !input.is_empty()) {
                readers.entry(input.clone()).or_default().push(index);
            }
        }
        let initializers =
            graph.initializer.iter().enumerate().map(|(i, tensor)| (tensor.name.clone(), i)).collect();
        let given_out = graph.output.iter().map(|output| output.name.clone()).collect();
        Self { graph, producers, readers, initializers, given_out, removed: HashSet::new() }
    }

    /// Number of nodes, those removed included.
    pub fn node_count(&self) -> usize {
        self.graph.node.len()
    }

    /// A node, unless it has been removed.
    pub fn node(&self, index: usize) -> Option<&NodeProto> {
        self.graph.node.get(index).filter(|_| !self.removed.contains(&index))
    }

    /// The node, if it is the operator `op` with one output.
    pub fn node_of(&self, index: usize, op: &str) -> Option<&NodeProto> {
        self.node(index).filter(|node| node.op_type == op && node.domain.is_empty() && node.output.len() == 1)
    }

    /// The operator `op` that makes a tensor.
    pub fn made_by(&self, tensor: &str, op: &str) -> Option<usize> {
        let index = *self.producers.get(tensor)?;
        self.node_of(index, op).map(|_| index)
    }

    /// The only node that reads a tensor, if one reads it once and the graph does not give it out.
    pub fn only_reader(&self, tensor: &str) -> Option<usize> {
        match self.readers.get(tensor)?.as_slice() {
            [single] if !self.given_out.contains(tensor) => Some(*single),
            _ => None,
        }
    }

    /// The elements of an initializer.
    pub fn constant(&self, tensor: &str) -> Option<Array> {
        Array::from_tensor(self.graph.initializer.get(*self.initializers.get(tensor)?)?)
    }

    /// An initializer of one float.
    pub fn scalar(&self, tensor: &str) -> Option<f32> {
        match self.constant(tensor)?.as_floats()? {
            [single] => Some(*single),
            _ => None,
        }
    }

    /// Adds an initializer with a name made from `hint`, and returns the name; `None` if it cannot be written.
    pub fn add_constant(&mut self, hint: &str, array: &Array) -> Option<String> {
        let taken = |name: &str| self.initializers.contains_key(name) || self.producers.contains_key(name);
        let mut name = hint.to_owned();
        let mut count = 1;
        while taken(&name) {
            count += 1;
            name = format!("{hint}_{count}");
        }
        self.initializers.insert(name.clone(), self.graph.initializer.len());
        self.graph.initializer.push(array.to_tensor(&name).ok()?);
        Some(name)
    }

    /// Makes a node read `tensor` as input `slot`, adding inputs as needed.
    pub fn set_input(&mut self, index: usize, slot: usize, tensor: &str) {
        let Some(node) = self.graph.node.get_mut(index) else { return };
        if node.input.len() <= slot {
            node.input.resize(slot + 1, String::new());
        }
        let old = std::mem::replace(&mut node.input[slot], tensor.to_owned());
        if let Some(readers) = self.readers.get_mut(&old)
            && let Some(position) = readers.iter().position(|&reader| reader == index)
        {
            readers.swap_remove(position);
        }
        self.readers.entry(tensor.to_owned()).or_default().push(index);
    }

    /// A node to change attributes of; inputs and outputs are changed through the rewriter.
    pub fn node_mut(&mut self, index: usize) -> Option<&mut NodeProto> {
        self.graph.node.get_mut(index)
    }

    /// Removes node `gone`, whose only output `keeper` makes from now on.
    pub fn absorb(&mut self, keeper: usize, gone: usize) {
        self.remove(gone);
        let Some(output) = self.graph.node.get(gone).and_then(|node| node.output.first()).cloned() else {
            return;
        };
        if let Some(slot) = self.graph.node.get_mut(keeper).and_then(|node| node.output.first_mut()) {
            *slot = output.clone();
        }
        self.producers.insert(output, keeper);
    }

    /// Removes a node that nothing reads any more.
    pub fn remove(&mut self, index: usize) {
        if self.removed.insert(index)
            && let Some(node) = self.graph.node.get(index)
        {
            for input in &node.input {
                if let Some(readers) = self.readers.get_mut(input) {
                    readers.retain(|&reader| reader != index);
                }
            }
        }
    }

    /// Drops the nodes that were removed.
    pub fn finish(self) {
        let mut index = 0;
        self.graph.node.retain(|_| {
            index += 1;
            !self.removed.contains(&(index - 1))
        });
    }
}
