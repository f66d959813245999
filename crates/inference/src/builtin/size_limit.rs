//! Rejection of models with tensors too large for memory, for which rten would abort the process.
//!
//! Two checks run before the first inference: constants that determine sizes, before rten evaluates them while
//! loading, and then the shapes that rten infers.

use std::collections::HashMap;

use opendr_engine::{Error, Result};
use rten::{Dimension, Model};

use crate::protobuf::{Fields, Value};

/// Maximum number of elements of a tensor.
const MAX_ELEMENTS: f64 = (1_u32 << 30) as f64;

/// Maximum enlargement of one `Resize`.
const MAX_ENLARGEMENT: f64 = (1_u32 << 16) as f64;

/// Maximum number of elements of a constant of sizes: two for each dimension.
const MAX_SIZES: usize = 16;

/// Checks the constants of the ONNX model `model` that operators take as sizes.
///
/// # Errors
/// `Format` with the operator and the constant.
pub(super) fn check_constants(model: &[u8]) -> Result<()> {
    for graph in messages(model, 7) {
        let graph = graph?;
        let mut constants = HashMap::new();
        for tensor in messages(graph, 5) {
            let constant = Constant::read(tensor?)?;
            constants.insert(constant.name, constant);
        }
        for node in messages(graph, 1) {
            let node = node?;
            let kind = messages(node, 4).next().transpose()?.unwrap_or_default();
            if kind == b"Constant" {
                let name = messages(node, 2).next().transpose()?.unwrap_or_default();
                for attribute in messages(node, 5) {
                    for tensor in messages(attribute?, 5) {
                        constants.insert(name, Constant { name, ..Constant::read(tensor?)? });
                    }
                }
            }
            // The inputs that are sizes, and their limit.
            let (sizes, most) = match kind {
                b"ConstantOfShape" => (0..1, MAX_ELEMENTS),
                b"Expand" | b"OneHot" | b"Pad" | b"Tile" => (1..2, MAX_ELEMENTS),
                b"Range" => (0..3, MAX_ELEMENTS),
                b"Resize" => (2..4, MAX_ENLARGEMENT),
                _ => continue,
            };
            for input in messages(node, 1).skip(sizes.start).take(sizes.len()) {
                let Some(constant) = constants.get(input?) else { continue };
                // The sizes of a `Resize`, unlike its scales, are integers.
                if constant.product() > if constant.whole { MAX_ELEMENTS } else { most } {
                    return Err(too_large(constant.name, "requests"));
                }
            }
        }
    }
    Ok(())
}

/// Checks the inferred shapes of `loaded` for the values in the ONNX model `model`.
///
/// # Errors
/// `Format` with the name of the value.
pub(super) fn check_shapes(loaded: &Model, model: &[u8]) -> Result<()> {
    for graph in messages(model, 7) {
        for node in messages(graph?, 1) {
            for output in messages(node?, 2) {
                let name = output?;
                let shape = std::str::from_utf8(name).ok().and_then(|name| loaded.find_node(name));
                let shape = shape.and_then(|id| loaded.node_info(id)?.shape()).unwrap_or_default();
                let elements: f64 = shape
                    .iter()
                    .map(|dim| match dim {
                        Dimension::Fixed(size) => *size as f64,
                        // Determined by the inputs of `run`.
                        Dimension::Symbolic(_) => 1.0,
                    })
                    .product();
                if elements > MAX_ELEMENTS {
                    return Err(too_large(name, "has"));
                }
            }
        }
    }
    Ok(())
}

fn too_large(name: &[u8], verb: &str) -> Error {
    let name = String::from_utf8_lossy(name);
    Error::format(format!(
        "damaged ONNX model: {name:?} {verb} more elements than the built-in runtime allows (2^30)"
    ))
}

/// Returns the fields with this number that contain bytes, text or messages.
fn messages(message: &[u8], number: u64) -> impl Iterator<Item = Result<&[u8]>> {
    Fields::new(message).filter_map(move |field| match field {
        Ok(field) if field.number == number => match field.value {
            Value::Bytes(bytes) => Some(Ok(bytes)),
            _ => None,
        },
        Ok(_) => None,
        Err(error) => Some(Err(error)),
    })
}

/// A short constant; longer ones are read without their elements.
struct Constant<'a> {
    name: &'a [u8],
    /// Whether its elements are integers.
    whole: bool,
    elements: Vec<f64>,
}

impl<'a> Constant<'a> {
    fn read(tensor: &'a [u8]) -> Result<Self> {
        let (mut name, mut data_type, mut elements) = (&[][..], 0, Vec::new());
        let mut raw: &[u8] = &[];
        for field in Fields::new(tensor) {
            let field = field?;
            match (field.number, field.value) {
                (2, Value::Varint(value)) => data_type = value,
                // float_data, int32_data, int64_data.
                (4, Value::Bytes(packed)) if packed.len() <= 4 * MAX_SIZES => elements.extend(floats(packed)),
                (5 | 7, Value::Varint(value)) if elements.len() < MAX_SIZES => {
                    elements.push(value.cast_signed() as f64)
                }
                (5 | 7, Value::Bytes(packed)) if packed.len() <= 10 * MAX_SIZES => {
                    let mut packed = Fields::new(packed);
                    elements.extend(std::iter::from_fn(|| Some(packed.varint()?.cast_signed() as f64)));
                }
                (8, Value::Bytes(bytes)) => name = bytes,
                (9, Value::Bytes(bytes)) if bytes.len() <= 8 * MAX_SIZES => raw = bytes,
                _ => {}
            }
        }
        match data_type {
            1 => elements.extend(floats(raw)),
            6 => elements.extend(raw.as_chunks().0.iter().map(|&bytes| f64::from(i32::from_le_bytes(bytes)))),
            7 => elements.extend(raw.as_chunks().0.iter().map(|&bytes| i64::from_le_bytes(bytes) as f64)),
            _ => {}
        }
        Ok(Self { name, whole: data_type != 1, elements })
    }

    /// Returns the largest enlargement that it causes.
    fn product(&self) -> f64 {
        self.elements.iter().map(|element| element.abs().max(1.0)).product()
    }
}

fn floats(bytes: &[u8]) -> impl Iterator<Item = f64> {
    bytes.as_chunks().0.iter().map(|&bytes| f64::from(f32::from_le_bytes(bytes)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protobuf::{put_bytes, put_varint};

    fn message(fields: &[(u64, &[u8])]) -> Vec<u8> {
        let mut message = Vec::new();
        fields.iter().for_each(|(number, bytes)| put_bytes(&mut message, *number, bytes));
        message
    }

    /// A model of one node with these constants: name, type, elements.
    fn model(kind: &[u8], constants: &[(&[u8], u64, &[u8])]) -> Vec<u8> {
        let (mut node, mut graph) = (Vec::new(), Vec::new());
        for &(name, data_type, raw) in constants {
            put_bytes(&mut node, 1, name);
            let mut tensor = Vec::new();
            put_varint(&mut tensor, 2 << 3);
            put_varint(&mut tensor, data_type);
            tensor.extend(message(&[(8, name), (9, raw)]));
            put_bytes(&mut graph, 5, &tensor);
        }
        node.extend(message(&[(4, kind)]));
        put_bytes(&mut graph, 1, &node);
        message(&[(7, &graph)])
    }

    #[test]
    fn sizes_are_limited_and_values_are_not() {
        let large = [1_i64 << 20, 1 << 20].map(i64::to_le_bytes).concat();
        let small = [1_i64 << 10, 1 << 10].map(i64::to_le_bytes).concat();
        let infinite = f32::NEG_INFINITY.to_le_bytes();
        let data = (&b"data"[..], 7, &large[..]);
        let check = |kind: &[u8], sizes: &[u8]| {
            check_constants(&model(kind, &[data, (b"sizes", 7, sizes), (b"value", 1, &infinite)]))
        };
        for kind in [&b"Expand"[..], b"Tile", b"Pad", b"OneHot"] {
            assert!(check(kind, &small).is_ok());
            assert!(check(kind, &large).unwrap_err().message().contains("\"sizes\" requests more elements"));
        }
        assert!(check(b"Add", &large).is_ok());
        let scales = [1.0_f32, 1.0, 300.0, 300.0].map(f32::to_le_bytes).concat();
        let resize =
            |scales: &[u8]| check_constants(&model(b"Resize", &[data, data, (b"scales", 1, scales)]));
        assert!(resize(&scales[..12]).is_ok());
        assert!(resize(&scales).is_err());
    }
}
