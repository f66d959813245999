//! Removal of `Identity` nodes.

use std::collections::{HashMap, HashSet};

use crate::proto::GraphProto;

/// Removes `Identity` nodes: readers read the original, and where the copy is a graph output, the original takes its
/// name. An `Identity` stays where it copies a graph input, an initializer or another output to an output.
pub fn remove_identities(graph: &mut GraphProto) {
    let given_out: HashSet<String> = graph.output.iter().map(|output| output.name.clone()).collect();
    let made: HashSet<String> = graph.node.iter().flat_map(|node| &node.output).cloned().collect();
    // Final name of each tensor. Nodes are in topological order, so that chains resolve in one sweep.
    let mut names: HashMap<String, String> = HashMap::new();
    for node in &graph.node {
        let ("Identity", [source], [copy]) =
            (node.op_type.as_str(), node.input.as_slice(), node.output.as_slice())
        else {
            continue;
        };
        let current = names.get(source).unwrap_or(source).clone();
        if !given_out.contains(copy) {
            names.insert(copy.clone(), current);
        } else if made.contains(source) && !given_out.contains(&current) {
            names.values_mut().filter(|name| **name == current).for_each(|name| *name = copy.clone());
            names.insert(current, copy.clone());
            names.insert(source.clone(), copy.clone());
        }
    }
    for node in &mut graph.node {
        for name in node.input.iter_mut().chain(&mut node.output) {
            if let Some(current) = names.get(name) {
                *name = current.clone();
            }
        }
    }
    graph.node.retain(|node| node.op_type != "Identity" || node.input != node.output);
}
