//! Weights in 16 bits: stored as `float16`, widened by a `Cast` as the model is opened.
//!
//! The arithmetic stays that of `float32`, so that every engine runs the model and answers as before, up to the
//! rounding of the weights (one part in 2048).

use std::collections::HashSet;

use opendr_onnx::proto::{DataType, GraphProto, NodeProto};
use opendr_onnx::{Array, Operator};

/// Smaller tensors stay: they would not pay for their `Cast`, and sizes and limits are among them.
const LEAST_ELEMENTS: usize = 128;

/// The largest `float16`.
const LARGEST: f32 = 65504.0;

/// Stores the float weights as `float16`; how many tensors.
pub fn halve_weights(graph: &mut GraphProto) -> usize {
    let inputs: HashSet<String> = graph.input.iter().map(|input| input.name.clone()).collect();
    let mut casts = Vec::new();
    for tensor in &mut graph.initializer {
        let Some(array) = Array::from_tensor(tensor).filter(|_| !inputs.contains(&tensor.name)) else {
            continue;
        };
        let Some(floats) = array.as_floats() else { continue };
        if floats.len() < LEAST_ELEMENTS || floats.iter().any(|value| value.is_nan() || value.abs() > LARGEST)
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
        tensor.raw_data = floats.iter().flat_map(|value| half_from_float(*value).to_le_bytes()).collect();
    }
    let count = casts.len();
    graph.node.splice(0..0, casts);
    count
}

/// The nearest `float16`, the even one of two, as its bits.
fn half_from_float(value: f32) -> u16 {
    let bits = value.to_bits();
    let sign = (bits >> 16 & 0x8000) as u16;
    let magnitude = f32::from_bits(bits & 0x7fff_ffff);
    if magnitude < 6.103_515_6e-5 {
        // Below the least normal number steps are equal: a sum with 0.5 has the same steps, and rounds.
        return sign | ((magnitude + 0.5).to_bits() - 0.5_f32.to_bits()) as u16;
    }
    let bits = bits & 0x7fff_ffff;
    let rounded = bits + 0xfff + (bits >> 13 & 1);
    let half = (rounded >> 13) - ((127 - 15) << 10);
    sign | if magnitude.is_nan() { 0x7e00 } else { half.min(0x7c00) as u16 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_onnx::Data;

    fn float_from_half(half: u16) -> f32 {
        let (exponent, fraction) = (i32::from(half >> 10 & 0x1f), f32::from(half & 0x3ff));
        let magnitude = match exponent {
            0 => fraction * 2f32.powi(-24),
            31 if fraction == 0.0 => f32::INFINITY,
            31 => f32::NAN,
            _ => (1024.0 + fraction) * 2f32.powi(exponent - 25),
        };
        if half & 0x8000 == 0 { magnitude } else { -magnitude }
    }

    #[test]
    fn every_half_comes_back_and_what_lies_between_goes_to_the_nearest() {
        for half in (0..=0x7bff_u16).chain(0x8000..=0xfbff) {
            assert_eq!(half_from_float(float_from_half(half)), half, "{half:#x}");
        }
        for half in 0..0x7bff_u16 {
            let (low, high) = (float_from_half(half), float_from_half(half + 1));
            let even = if half % 2 == 0 { half } else { half + 1 };
            assert_eq!(half_from_float((low + high) / 2.0), even, "{half:#x}");
            assert_eq!(half_from_float(low + (high - low) * 0.49), half, "{half:#x}");
            assert_eq!(half_from_float(-low - (high - low) * 0.51), half + 0x8001, "{half:#x}");
        }
        assert_eq!(half_from_float(1e6), 0x7c00);
        assert!(float_from_half(half_from_float(f32::NAN)).is_nan());
    }

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
        assert_eq!(halve_weights(&mut graph), 1);
        let [cast] = graph.node.as_slice() else { panic!("{:?}", graph.node) };
        assert_eq!((cast.input[0].as_str(), cast.output[0].as_str()), ("weights/half", "weights"));
        assert_eq!(graph.initializer[0].raw_data, [0x00, 0x34].repeat(LEAST_ELEMENTS));
        assert_eq!(graph.initializer[1].name, "large");
    }
}
