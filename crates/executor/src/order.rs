//! The order of nodes.

use std::collections::{HashMap, HashSet};

use opendr_engine::{Error, Result};
use opendr_onnx::proto::NodeProto;

use crate::constant::Constants;

/// Orders nodes so that each follows the producers of its inputs.
pub(crate) fn ordered(
    nodes: Vec<NodeProto>,
    constants: &Constants,
    inputs: &[String],
) -> Result<Vec<NodeProto>> {
    let mut known: HashSet<String> = constants.keys().cloned().collect();
    known.extend(inputs.iter().cloned());
    let mut produced: HashMap<&str, usize> = HashMap::new();
    for (index, node) in nodes.iter().enumerate() {
        for output in node.output.iter().filter(|output| !output.is_empty()) {
            if known.contains(output) || produced.insert(output, index).is_some() {
                return Err(Error::format(format!(
                    "damaged ONNX model: the value {output:?} is produced twice"
                )));
            }
        }
    }
    let mut waiting = vec![0_usize; nodes.len()];
    let mut followers: Vec<Vec<usize>> = vec![Vec::new(); nodes.len()];
    for (index, node) in nodes.iter().enumerate() {
        for input in node.input.iter().filter(|input| !input.is_empty() && !known.contains(*input)) {
            let Some(&producer) = produced.get(input.as_str()) else {
                return Err(Error::format(format!(
                    "damaged ONNX model: nothing produces the value {input:?}"
                )));
            };
            waiting[index] += 1;
            followers[producer].push(index);
        }
    }
    // The lowest node that can run comes first: the order of the file where that is one.
    let mut ready: std::collections::BTreeSet<usize> =
        (0..nodes.len()).filter(|&index| waiting[index] == 0).collect();
    let mut order = Vec::with_capacity(nodes.len());
    while let Some(index) = ready.pop_first() {
        order.push(index);
        for &follower in &followers[index] {
            waiting[follower] -= 1;
            if waiting[follower] == 0 {
                ready.insert(follower);
            }
        }
    }
    if order.len() < nodes.len() {
        return Err(Error::format("damaged ONNX model: its graph has a cycle"));
    }
    let mut nodes: Vec<Option<NodeProto>> = nodes.into_iter().map(Some).collect();
    Ok(order.into_iter().filter_map(|index| nodes.get_mut(index).and_then(Option::take)).collect())
}
