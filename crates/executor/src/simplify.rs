//! Rewriting of a graph before it is planned.

use std::collections::{HashMap, HashSet};

use half::f16;
use half::slice::{HalfBitsSliceExt, HalfFloatSliceExt};
use opendr_engine::Result;
use opendr_onnx::passes;
use opendr_onnx::proto::{DataType, GraphProto, TensorProto};

use crate::constant::Constant;

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
        if tensor.data_type != i32::from(DataType::Float16) {
            continue;
        }
        let constant = Constant::from_tensor(tensor.clone())?;
        let halves = constant.numbers::<u16>().reinterpret_cast::<f16>();
        let mut raw_data = vec![0; 2 * constant.bytes()];
        let mut floats = [0.0; 256];
        for (halves, raw) in halves.chunks(floats.len()).zip(raw_data.chunks_mut(size_of_val(&floats))) {
            let floats = &mut floats[..halves.len()];
            halves.convert_to_f32_slice(floats);
            raw.as_chunks_mut().0.iter_mut().zip(floats).for_each(|(raw, float)| *raw = float.to_le_bytes());
        }
        let tensor = TensorProto {
            dims: tensor.dims.clone(),
            data_type: DataType::Float.into(),
            name: output.clone(),
            raw_data,
            ..TensorProto::default()
        };
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
