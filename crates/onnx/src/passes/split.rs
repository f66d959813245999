use std::collections::HashSet;

use crate::array::Array;
use crate::operator::Operator;
use crate::proto::{GraphProto, NodeProto, TensorProto};

/// The nodes that replace a node, and their constants.
#[derive(Default)]
pub(super) struct Split {
    nodes: Vec<NodeProto>,
    constants: Vec<TensorProto>,
}

impl Split {
    /// Adds an operator.
    pub(super) fn node(mut self, operator: Operator, input: &[&str], output: &str) -> Self {
        self.nodes.push(NodeProto {
            input: input.iter().map(|&input| input.to_owned()).collect(),
            output: vec![output.to_owned()],
            ..operator.into_node(output)
        });
        self
    }

    /// Adds a constant.
    pub(super) fn constant(mut self, name: &str, array: &Array) -> Option<Self> {
        self.constants.push(array.to_tensor(name).ok()?);
        Some(self)
    }
}

/// Replaces nodes by those that `split` returns for a node and its index. New names consist of the output's name and
/// a suffix after a `/`; a node stays where one of them is used, or where the constants would grow to more than four
/// times those of the model. Returns whether any node was replaced.
pub(super) fn split_nodes(
    graph: &mut GraphProto,
    mut split: impl FnMut(usize, &NodeProto) -> Option<Split>,
) -> bool {
    let mut names: HashSet<String> = graph.node.iter().flat_map(|node| node.output.iter().cloned()).collect();
    names.extend(graph.initializer.iter().map(|tensor| tensor.name.clone()));
    names.extend(graph.input.iter().map(|input| input.name.clone()));
    let mut room =
        graph.initializer.iter().map(bytes).sum::<usize>().saturating_mul(4).saturating_add(1 << 16);
    let mut nodes = Vec::with_capacity(graph.node.len());
    let mut any = false;
    for (index, node) in std::mem::take(&mut graph.node).into_iter().enumerate() {
        let made = split(index, &node).filter(|split| {
            let outputs = split.nodes.iter().flat_map(|node| &node.output);
            let mut new = outputs.chain(split.constants.iter().map(|tensor| &tensor.name));
            new.all(|name| node.output.contains(name) || !names.contains(name))
        });
        let cost = made.as_ref().map_or(0, |split| split.constants.iter().map(bytes).sum());
        match made {
            Some(split) if cost <= room => {
                room -= cost;
                any = true;
                names.extend(split.nodes.iter().flat_map(|node| node.output.iter().cloned()));
                names.extend(split.constants.iter().map(|tensor| tensor.name.clone()));
                nodes.extend(split.nodes);
                graph.initializer.extend(split.constants);
            }
            _ => nodes.push(node),
        }
    }
    graph.node = nodes;
    any
}

fn bytes(tensor: &TensorProto) -> usize {
    tensor.raw_data.len().saturating_add(4 * tensor.float_data.len())
}
