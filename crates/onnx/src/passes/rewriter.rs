//! Indexed access to a graph for rewriting.

use std::collections::{HashMap, HashSet};

use crate::array::{Array, element_count};
use crate::proto::{GraphProto, NodeProto};

/// A graph with an index of the producer and the readers of each tensor, and the methods to change it. The cost of a
/// change is proportional to its size, not to that of the graph. Nodes are only marked as removed until
/// [`Rewriter::finish`].
pub struct Rewriter<'a> {
    graph: &'a mut GraphProto,
    producers: HashMap<String, usize>,
    readers: HashMap<String, Vec<usize>>,
    initializers: HashMap<String, usize>,
    given_out: HashSet<String>,
    removed: HashSet<usize>,
    /// Number of constant elements that may still be added.
    budget: usize,
}

impl<'a> Rewriter<'a> {
    /// Indexes the graph.
    pub fn new(graph: &'a mut GraphProto) -> Self {
        let initializers: HashMap<String, usize> = graph
            .initializer
            .iter()
            .enumerate()
            .map(|(index, tensor)| (tensor.name.clone(), index))
            .collect();
        let mut producers = HashMap::new();
        let mut readers: HashMap<String, Vec<usize>> = HashMap::new();
        for (index, node) in graph.node.iter().enumerate() {
            producers.extend(node.output.iter().map(|output| (output.clone(), index)));
            for input in node.input.iter().filter(|input| !initializers.contains_key(*input)) {
                readers.entry(input.clone()).or_default().push(index);
            }
        }
        let given_out = graph.output.iter().map(|output| output.name.clone()).collect();
        let raw: usize = graph.initializer.iter().map(|tensor| tensor.raw_data.len()).sum();
        let budget = raw.saturating_add(1 << 16);
        Self { graph, producers, readers, initializers, given_out, removed: HashSet::new(), budget }
    }

    /// Returns the number of nodes, removed ones included.
    pub fn node_count(&self) -> usize {
        self.graph.node.len()
    }

    /// Returns a node, unless it has been removed.
    pub fn node(&self, index: usize) -> Option<&NodeProto> {
        self.graph.node.get(index).filter(|_| !self.removed.contains(&index))
    }

    /// Returns the node, if it is the operator `op` with one output.
    pub fn node_of(&self, index: usize, op: &str) -> Option<&NodeProto> {
        self.node(index).filter(|node| node.op_type == op && node.domain.is_empty() && node.output.len() == 1)
    }

    /// Returns the operator `op` that produces a tensor.
    pub fn producer(&self, tensor: &str, op: &str) -> Option<usize> {
        let index = *self.producers.get(tensor)?;
        self.node_of(index, op).map(|_| index)
    }

    /// Returns the only node that reads a tensor, if one node reads it once and it is not a graph output.
    pub fn only_reader(&self, tensor: &str) -> Option<usize> {
        match self.readers.get(tensor)?.as_slice() {
            [single] if !self.given_out.contains(tensor) => Some(*single),
            _ => None,
        }
    }

    /// Returns the nodes that read a tensor; `None` if it is a graph output or nothing reads it.
    pub fn readers(&self, tensor: &str) -> Option<&[usize]> {
        let readers = self.readers.get(tensor).map(Vec::as_slice);
        readers.filter(|readers| !readers.is_empty() && !self.given_out.contains(tensor))
    }

    /// Returns the dimensions of an initializer.
    pub fn constant_dims(&self, tensor: &str) -> Option<Vec<usize>> {
        let tensor = self.graph.initializer.get(*self.initializers.get(tensor)?)?;
        tensor.dims.iter().map(|&dim| usize::try_from(dim).ok()).collect()
    }

    /// Returns whether a constant of that many elements may be added. Otherwise a graph whose nodes share large
    /// constants could grow without bound when each node gets its own copy.
    pub fn can_add_constant(&self, elements: usize) -> bool {
        elements <= self.budget
    }

    /// Returns the elements of an initializer.
    pub fn constant(&self, tensor: &str) -> Option<Array> {
        Array::from_tensor(self.graph.initializer.get(*self.initializers.get(tensor)?)?)
    }

    /// Returns the value of an initializer of one float.
    pub fn scalar(&self, tensor: &str) -> Option<f32> {
        match element_count(&self.constant_dims(tensor)?)? {
            1 => self.constant(tensor)?.as_floats()?.first().copied(),
            _ => None,
        }
    }

    /// Adds an initializer with a name derived from `hint`, and returns the name; `None` when the graph has grown too
    /// much.
    pub fn add_constant(&mut self, hint: &str, array: &Array) -> Option<String> {
        self.budget = self.budget.checked_sub(array.data().len())?;
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

    /// Connects input `slot` of a node to `tensor`, adding inputs as needed.
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

    /// Connects all readers of one tensor to another.
    pub fn redirect(&mut self, from: &str, to: &str) {
        let readers = self.readers.remove(from).unwrap_or_default();
        for &reader in &readers {
            let inputs = self.graph.node.get_mut(reader).into_iter().flat_map(|node| &mut node.input);
            inputs.filter(|input| *input == from).for_each(|input| *input = to.to_owned());
        }
        self.readers.entry(to.to_owned()).or_default().extend(readers);
    }

    /// Replaces a node by another operator without attributes and with other inputs; its output stays.
    pub fn replace(&mut self, index: usize, op: &str, inputs: &[String]) {
        self.unlink(index);
        if let Some(node) = self.graph.node.get_mut(index) {
            node.op_type = op.to_owned();
            node.attribute.clear();
            node.input = inputs.to_vec();
        }
        for input in inputs {
            self.readers.entry(input.clone()).or_default().push(index);
        }
    }

    /// Returns a node to change its attributes; inputs and outputs are changed through the rewriter.
    pub fn node_mut(&mut self, index: usize) -> Option<&mut NodeProto> {
        self.graph.node.get_mut(index)
    }

    /// Removes node `gone`; `keeper` then produces its only output.
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

    /// Removes a node without readers.
    pub fn remove(&mut self, index: usize) {
        if self.removed.insert(index) {
            self.unlink(index);
        }
    }

    /// Removes a node from the readers of its inputs.
    fn unlink(&mut self, index: usize) {
        let inputs = self.graph.node.get(index).into_iter().flat_map(|node| &node.input);
        for input in inputs {
            if let Some(readers) = self.readers.get_mut(input) {
                readers.retain(|&reader| reader != index);
            }
        }
    }

    /// Drops the removed nodes.
    pub fn finish(self) {
        let mut index = 0;
        self.graph.node.retain(|_| {
            index += 1;
            !self.removed.contains(&(index - 1))
        });
    }
}
