//! Weights in 16 bits: stored as `float16`, converted by a `Cast` when the model is opened.
//!
//! The arithmetic stays `float32`, so that every runtime runs the model and the outputs change only by the rounding
//! of the weights (one part in 2048).

use std::collections::HashSet;

use half::f16;

use crate::array::bytes_of;
use crate::proto::{DataType, GraphProto, NodeProto};
use crate::{Array, Operator};

/// Minimum size of converted tensors: for smaller ones, which include sizes and limits, the `Cast` costs more than it
/// saves.
const LEAST_ELEMENTS: usize = 128;

/// Stores the float weights as `float16`; returns the number of converted tensors.
pub fn weights_to_fp16(graph: &mut GraphProto) -> usize {
    let inputs: HashSet<String> = graph.input.iter().map(|input| input.name.clone()).collect();
    let mut casts = Vec::new();
    for tensor in &mut graph.initializer {
        let Some(array) = Array::from_tensor(tensor).filter(|_| !inputs.contains(&tensor.name)) else {
            continue;
        };
        let Some(floats) = array.as_floats() else { continue };
        if floats.len() < LEAST_ELEMENTS
            || floats.iter().any(|value| value.is_nan() || value.abs() > f16::MAX.to_f32())
        {
            continue;
        }
        let name = format!("{}/half", tensor.name);
        casts.push(NodeProto {
            op_type: "Cast".to_owned(),
            input: vec![name.clone()],
            output: vec![std::mem::replace(&mut tensor.name, name)],
            attribute: Operator::new("Cast").int("to", DataType::Float as i64).attributes().to_vec(),
            ..NodeProto::default()
        });
        tensor.data_type = DataType::Float16 as i32;
        tensor.float_data.clear();
        tensor.raw_data = bytes_of(floats, |value| f16::from_f32(value).to_le_bytes());
    }
    let count = casts.len();
    graph.node.splice(0..0, casts);
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Data;

    #[test]
    fn only_large_floats_within_range_are_halved() {
        let tensor =
            |name: &str, data: Data| Array::new(vec![data.len()], data).unwrap().to_tensor(name).unwrap();
        let mut too_large = vec![0.5; LEAST_ELEMENTS];
        too_large[3] = 1e5;
        let mut graph = GraphProto {
            initializer: vec![
                tensor("weights", Data::Float(vec![0.25; LEAST_ELEMENTS])),
                tensor("large", Data::Float(too_large)),
                tensor("small", Data::Float(vec![0.5; LEAST_ELEMENTS - 1])),
                tensor("indices", Data::Int(vec![1; LEAST_ELEMENTS])),
            ],
            ..GraphProto::default()
        };
        assert_eq!(weights_to_fp16(&mut graph), 1);
        let [cast] = graph.node.as_slice() else { panic!("{:?}", graph.node) };
        assert_eq!((cast.input[0].as_str(), cast.output[0].as_str()), ("weights/half", "weights"));
        assert_eq!(graph.initializer[0].raw_data, [0x00, 0x34].repeat(LEAST_ELEMENTS));
        assert_eq!(graph.initializer[1].name, "large");
    }
}
