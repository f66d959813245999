//! Rewriting of per-channel `PRelu` as convolutions.

use std::collections::HashMap;

use super::split::{Split, split_nodes};
use crate::array::{Array, Data};
use crate::operator::Operator;
use crate::proto::{GraphProto, NodeProto};

/// Operators that keep the rank of their first input.
const KEEP_RANK: [&str; 9] =
    ["Add", "Clip", "LeakyRelu", "MaxPool", "PRelu", "Pad", "Relu", "Resize", "Concat"];

/// Maximum number of steps back from an activation to the convolution that determines the rank.
const MOST_STEPS: usize = 64;

/// Rewrites `PRelu(x)` with a slope `a` per channel of images as `a * x + (1 - a) * Relu(x)`, with the products as
/// depthwise 1x1 convolutions, and with a single slope as `LeakyRelu(x)`. On CPUs, ONNX Runtime keeps its blocked
/// layout through these; around `PRelu` it converts back and forth. Returns whether any node was rewritten.
pub fn prelu_to_conv(graph: &mut GraphProto) -> bool {
    let slopes = slopes_of(graph);
    if slopes.is_empty() {
        return false;
    }
    split_nodes(graph, |index, node| match slopes.get(&index)?.as_slice() {
        [one] => leaky(node, *one),
        slope => split(node, slope),
    })
}

/// Returns the slopes of each activation that can be rewritten, by node index.
fn slopes_of(graph: &GraphProto) -> HashMap<usize, Vec<f32>> {
    let is_prelu = |node: &NodeProto| {
        node.op_type == "PRelu" && node.domain.is_empty() && node.input.len() == 2 && node.output.len() == 1
    };
    if !graph.node.iter().any(is_prelu) {
        return HashMap::new();
    }
    let constants: HashMap<&str, _> =
        graph.initializer.iter().map(|tensor| (tensor.name.as_str(), tensor)).collect();
    let producers: HashMap<&str, &NodeProto> = graph
        .node
        .iter()
        .flat_map(|node| node.output.iter().map(move |name| (name.as_str(), node)))
        .collect();
    let is_picture = |tensor: &str| {
        let mut tensor = tensor;
        for _ in 0..MOST_STEPS {
            let Some(node) = producers.get(tensor) else { return false };
            match (node.op_type.as_str(), node.input.as_slice()) {
                ("Conv", [_, weights, ..]) => {
                    return constants.get(weights.as_str()).is_some_and(|weights| weights.dims.len() == 4);
                }
                (op, [first, ..]) if KEEP_RANK.contains(&op) => tensor = first,
                _ => return false,
            }
        }
        false
    };
    let slope = |node: &NodeProto| {
        let tensor = constants.get(node.input.get(1)?.as_str())?;
        let (channels, others) = match *tensor.dims.as_slice() {
            [channels, height, width] => (channels, [1, height, width]),
            [batch, channels, height, width] => (channels, [batch, height, width]),
            _ => return None,
        };
        if others != [1; 3] || channels < 1 || !is_picture(node.input.first()?) {
            return None;
        }
        let slope = Array::from_tensor(tensor)?.as_floats()?.to_vec();
        slope.iter().all(|slope| slope.is_finite()).then_some(slope)
    };
    let places = graph.node.iter().enumerate().filter(|(_, node)| is_prelu(node));
    places.filter_map(|(index, node)| Some((index, slope(node)?))).collect()
}

fn leaky(node: &NodeProto, slope: f32) -> Option<Split> {
    let ([x, _], [output]) = (node.input.as_slice(), node.output.as_slice()) else { return None };
    Some(Split::default().node(Operator::new("LeakyRelu").float("alpha", slope), &[x], output))
}

fn split(node: &NodeProto, slope: &[f32]) -> Option<Split> {
    let ([x, _], [output]) = (node.input.as_slice(), node.output.as_slice()) else { return None };
    let [positive, below, above, scale, rest] =
        &["positive", "below", "above", "slope", "rest"].map(|part| format!("{output}/{part}"));
    let of_slope = |of: fn(f32) -> f32| {
        let data = slope.iter().map(|slope| of(*slope)).collect();
        Array::new(vec![slope.len(), 1, 1, 1], Data::Float(data))
    };
    let channels = i64::try_from(slope.len()).ok()?;
    let conv = || Operator::new("Conv").int("group", channels).ints("kernel_shape", [1, 1]);
    let split = Split::default()
        .constant(scale, &of_slope(|slope| slope)?)?
        .constant(rest, &of_slope(|slope| 1.0 - slope)?)?
        .node(Operator::new("Relu"), &[x], positive)
        .node(conv(), &[x, scale], below)
        .node(conv(), &[positive, rest], above)
        .node(Operator::new("Add"), &[above, below], output);
    Some(split)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn constant(name: &str, dims: &[usize], value: f32) -> crate::proto::TensorProto {
        let data = Data::Float(vec![value; dims.iter().product()]);
        Array::new(dims.to_vec(), data).unwrap().to_tensor(name).unwrap()
    }

    /// Returns a graph with a convolution of `rank` dimensions and a `PRelu` with slopes of shape `dims`.
    fn graph(rank: usize, dims: &[usize]) -> GraphProto {
        let node = |operator: &'static str, input: [&str; 2], output: &str| NodeProto {
            input: input.map(str::to_owned).to_vec(),
            output: vec![output.to_owned()],
            ..Operator::new(operator).into_node(output)
        };
        let mut weights = vec![1; rank];
        weights[0] = 3;
        GraphProto {
            node: vec![node("Conv", ["x", "w"], "c"), node("PRelu", ["c", "a"], "y")],
            initializer: vec![constant("w", &weights, 1.0), constant("a", dims, 0.25)],
            ..GraphProto::default()
        }
    }

    fn operators(graph: &GraphProto) -> Vec<&str> {
        graph.node.iter().map(|node| node.op_type.as_str()).collect()
    }

    #[test]
    fn a_slope_of_channels_becomes_convolutions() {
        for dims in [&[3, 1, 1][..], &[1, 3, 1, 1]] {
            let mut graph = graph(4, dims);
            assert!(prelu_to_conv(&mut graph));
            assert_eq!(operators(&graph), ["Conv", "Relu", "Conv", "Conv", "Add"]);
            let last = graph.node.last().unwrap();
            assert_eq!(
                (last.input.as_slice(), last.output.as_slice()),
                (["y/above".to_owned(), "y/below".to_owned()].as_slice(), ["y".to_owned()].as_slice(),)
            );
            let rest = graph.initializer.iter().find(|tensor| tensor.name == "y/rest").unwrap();
            assert_eq!(Array::from_tensor(rest).unwrap().as_floats().unwrap(), [0.75; 3]);
        }
    }

    #[test]
    fn one_slope_for_all_is_leaky() {
        let mut graph = graph(4, &[1, 1, 1]);
        assert!(prelu_to_conv(&mut graph));
        assert_eq!(operators(&graph), ["Conv", "LeakyRelu"]);
        assert_eq!(graph.node[1].find("alpha").unwrap().f, 0.25);
    }

    #[test]
    fn other_slopes_are_unchanged() {
        for (rank, dims) in
            [(3, &[3, 1, 1][..]), (5, &[3, 1, 1]), (4, &[3]), (4, &[3, 2, 1]), (4, &[2, 3, 1, 1])]
        {
            let mut graph = graph(rank, dims);
            assert!(!prelu_to_conv(&mut graph), "{rank} {dims:?}");
            assert_eq!(operators(&graph), ["Conv", "PRelu"]);
        }
        let mut taken = graph(4, &[3, 1, 1]);
        taken.initializer.push(constant("y/rest", &[1], 0.0));
        prelu_to_conv(&mut taken);
        assert_eq!(operators(&taken), ["Conv", "PRelu"]);
    }
}
