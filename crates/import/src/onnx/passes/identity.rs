//! Removes nodes that hand on what they get.

use super::links::Links;
use crate::onnx::proto::GraphProto;

/// Removes `Identity` nodes: readers read the original, and where the graph gives the copy out, the node that made the
/// original gives it the output's name. One stays where a graph input, an initializer or a second output is given out.
pub fn remove_identities(graph: &mut GraphProto) {
    let mut index = 0;
    while index < graph.node.len() {
        let links = &graph.node[index];
        let (source, copy) = match (links.op_type.as_str(), links.input.as_slice(), links.output.as_slice()) {
            ("Identity", [source], [copy]) => (source.clone(), copy.clone()),
            _ => {
                index += 1;
                continue;
            }
        };
        let given_out = |name: &str| graph.output.iter().any(|output| output.name == name);
        let removed = match (given_out(&copy), given_out(&source)) {
            (false, _) => rename_reads(graph, &copy, &source),
            (true, false) => Links::of(graph).producer(&source).is_some_and(|maker| {
                let outputs = &mut graph.node[maker].output;
                outputs
                    .iter_mut()
                    .filter(|output| **output == source)
                    .for_each(|output| *output = copy.clone());
                rename_reads(graph, &source, &copy)
            }),
            (true, true) => false,
        };
        if removed {
            graph.node.remove(index);
        } else {
            index += 1;
        }
    }
}

fn rename_reads(graph: &mut GraphProto, from: &str, to: &str) -> bool {
    let inputs = graph.node.iter_mut().flat_map(|node| &mut node.input);
    inputs.filter(|input| *input == from).for_each(|input| *input = to.to_owned());
    true
}
