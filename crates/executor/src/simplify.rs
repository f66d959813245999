//! Rewriting of a graph before it is planned.

use std::collections::{HashMap, HashSet};

use half::f16;
use opendr_engine::Result;
use opendr_onnx::passes;
use opendr_onnx::proto::GraphProto;

use crate::constant::Constant;
use crate::tensor::Kind;

/// Runs the passes that need no shapes. They know operators of opset 11 and later.
pub(crate) fn simplify(graph: &mut GraphProto, opset: i64) -> Result<()> {
    widen_half_constants(graph)?;
    if opset >= 11 {
        passes::simplify(graph);
    } else {
        passes::remove_identities(graph);
        passes::fold_affine_into_conv(graph);
        passes::remove_dead_nodes(graph);
    }
    Ok(())
}

/// Evaluates casts of 16-bit weights, so that passes see constants.
fn widen_half_constants(graph: &mut GraphProto) -> Result<()> {
    let by_name: HashMap<&str, usize> =
        graph.initializer.iter().enumerate().map(|(i, tensor)| (tensor.name.as_str(), i)).collect();
    let mut widened = Vec::new();
    for (index, node) in graph.node.iter().enumerate() {
        let ([input], [output], "Cast", 1) =
            (node.input.as_slice(), node.output.as_slice(), node.op_type.as_str(), node.int_or("to", 0))
        else {
            continue;
        };
        let Some(tensor) = by_name.get(input.as_str()).and_then(|&i| graph.initializer.get(i)) else {
            continue;
        };
        let constant = Constant::from_tensor(tensor)?;
        if constant.kind != Kind::F16 {
            continue;
        }
        let halves = constant.data.get::<u16>(constant.region());
        let raw_data = halves.iter().flat_map(|&half| f16::from_bits(half).to_f32().to_le_bytes()).collect();
        let mut tensor = tensor.clone();
        tensor.name.clone_from(output);
        tensor.data_type = 1;
        tensor.int32_data.clear();
        tensor.raw_data = raw_data;
        widened.push((index, tensor));
    }
    let gone: HashSet<usize> = widened.iter().map(|(index, _)| *index).collect();
    let mut index = 0;
    graph.node.retain(|_| {
        index += 1;
        !gone.contains(&(index - 1))
    });
    graph.initializer.extend(widened.into_iter().map(|(_, tensor)| tensor));
    let read: HashSet<&str> = graph.node.iter().flat_map(|node| &node.input).map(String::as_str).collect();
    let outputs: HashSet<&str> = graph.output.iter().map(|output| output.name.as_str()).collect();
    graph
        .initializer
        .retain(|tensor| read.contains(tensor.name.as_str()) || outputs.contains(tensor.name.as_str()));
    Ok(())
}
