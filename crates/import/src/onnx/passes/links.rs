//! Who makes and who reads each tensor.

use std::collections::HashMap;

use crate::onnx::proto::GraphProto;

/// Who makes and who reads each tensor of a graph, by index into its nodes.
#[derive(Debug, Default)]
pub struct Links {
    producers: HashMap<String, usize>,
    readers: HashMap<String, Vec<usize>>,
    initializers: HashMap<String, usize>,
}

impl Links {
    /// Reads the graph; a graph output counts as a reader with the index `usize::MAX`.
    pub fn of(graph: &GraphProto) -> Self {
        let mut links = Self::default();
        for (index, node) in graph.node.iter().enumerate() {
            for output in node.output.iter().filter(|name| !name.is_empty()) {
                links.producers.insert(output.clone(), index);
            }
            for input in node.input.iter().filter(|name| !name.is_empty()) {
                links.readers.entry(input.clone()).or_default().push(index);
            }
        }
        for output in &graph.output {
            links.readers.entry(output.name.clone()).or_default().push(usize::MAX);
        }
        for (index, tensor) in graph.initializer.iter().enumerate() {
            links.initializers.insert(tensor.name.clone(), index);
        }
        links
    }

    /// The node that makes a tensor.
    pub fn producer(&self, tensor: &str) -> Option<usize> {
        self.producers.get(tensor).copied()
    }

    /// The nodes that read a tensor.
    pub fn readers(&self, tensor: &str) -> &[usize] {
        self.readers.get(tensor).map_or(&[], Vec::as_slice)
    }

    /// The only node that reads a tensor, if there is just one reading it once and the graph does not give it out.
    pub fn only_reader(&self, tensor: &str) -> Option<usize> {
        match self.readers(tensor) {
            [single] if *single != usize::MAX => Some(*single),
            _ => None,
        }
    }

    /// The initializer of that name.
    pub fn initializer(&self, tensor: &str) -> Option<usize> {
        self.initializers.get(tensor).copied()
    }
}
