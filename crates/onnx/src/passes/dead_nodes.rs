//! Dead-code elimination.

use std::collections::HashSet;

use crate::proto::{AttributeProto, GraphProto};

/// Removes nodes and initializers that no output of the graph needs. Graph inputs stay, as part of the interface.
pub fn remove_dead_nodes(graph: &mut GraphProto) {
    remove_unneeded(graph);
}

/// Does the same and returns the names of the values that remain.
pub(super) fn remove_unneeded(graph: &mut GraphProto) -> HashSet<String> {
    let mut needed: HashSet<String> = graph.output.iter().map(|output| output.name.clone()).collect();
    // Nodes are in topological order.
    let mut keep = vec![false; graph.node.len()];
    for (index, node) in graph.node.iter().enumerate().rev() {
        if node.output.iter().any(|output| !output.is_empty() && needed.contains(output)) {
            keep[index] = true;
            needed.extend(node.input.iter().cloned());
            node.attribute.iter().for_each(|attribute| captured(attribute, &mut needed));
        }
    }
    let mut keep = keep.into_iter();
    graph.node.retain(|_| keep.next().unwrap_or(true));
    graph.initializer.retain(|tensor| needed.contains(&tensor.name));
    graph.value_info.retain(|info| needed.contains(&info.name));
    needed
}

/// Collects the names that the subgraphs of loops and branches read, including those of their own values.
fn captured(attribute: &AttributeProto, needed: &mut HashSet<String>) {
    for graph in attribute.g.iter().chain(&attribute.graphs) {
        needed.extend(graph.output.iter().map(|output| output.name.clone()));
        for node in &graph.node {
            needed.extend(node.input.iter().cloned());
            node.attribute.iter().for_each(|attribute| captured(attribute, needed));
        }
    }
}
