//! Reading of the binary weight files.

use std::collections::BTreeMap;

use half::f16;
use opendr_engine::{Error, Result};

use super::model_json::{ModelJson, Quantization, Weight};
use opendr_onnx::{Array, Data, element_count};

/// Returns the weights by name, decoded from the files of the manifest in its order. Every size is checked against
/// the available bytes before memory is allocated.
///
/// # Errors
/// `Format` when files are missing or too short, `Unsupported` for an element type such as strings.
pub fn read_weights(model: &ModelJson, files: &[&[u8]]) -> Result<BTreeMap<String, Array>> {
    let expected: usize = model.weights_manifest.iter().map(|group| group.paths.len()).sum();
    if expected != files.len() {
        return Err(Error::format(format!(
            "the manifest lists {expected} weight files, but {} were passed",
            files.len()
        )));
    }
    let mut weights = BTreeMap::new();
    let mut files = files.iter();
    for group in &model.weights_manifest {
        let shards: Vec<&[u8]> = files.by_ref().take(group.paths.len()).copied().collect();
        let joined;
        let mut bytes = match shards.as_slice() {
            [single] => *single,
            shards => {
                joined = shards.concat();
                joined.as_slice()
            }
        };
        for weight in &group.weights {
            let (array, rest) = decode(weight, bytes)?;
            bytes = rest;
            weights.insert(weight.name.clone(), array);
        }
    }
    Ok(weights)
}

fn decode<'a>(weight: &Weight, bytes: &'a [u8]) -> Result<(Array, &'a [u8])> {
    let Weight { name, shape, dtype, quantization } = weight;
    let stored = quantization.as_ref().map_or(dtype.as_str(), |quantization| quantization.dtype.as_str());
    let width = match stored {
        "float32" | "int32" => 4,
        "float16" | "uint16" => 2,
        "uint8" | "bool" => 1,
        _ => return Err(Error::unsupported(format!("weight {name:?} has the unsupported type {stored:?}"))),
    };
    let size = element_count(shape).and_then(|count| count.checked_mul(width));
    let Some((own, rest)) = size.and_then(|size| bytes.split_at_checked(size)) else {
        return Err(Error::format(format!(
            "weight {name:?} of shape {shape:?} needs more than the {} remaining bytes of its file; download the file again",
            bytes.len()
        )));
    };
    let data = match (stored, dtype.as_str()) {
        ("float32", _) => Data::Float(own.as_chunks().0.iter().map(|&b| f32::from_le_bytes(b)).collect()),
        ("float16", _) => {
            Data::Float(own.as_chunks().0.iter().map(|&b| f16::from_le_bytes(b).to_f32()).collect())
        }
        ("int32", _) => Data::Int(own.as_chunks().0.iter().map(|&b| i32::from_le_bytes(b).into()).collect()),
        ("bool", _) => Data::Bool(own.iter().map(|&byte| byte != 0).collect()),
        ("uint8", _) => dequantized(dtype, quantization, own.iter().map(|&byte| byte.into())),
        _ => {
            dequantized(dtype, quantization, own.as_chunks().0.iter().map(|&b| u16::from_le_bytes(b).into()))
        }
    };
    match Array::new(shape.clone(), data) {
        Some(array) => Ok((array, rest)),
        None => Err(Error::internal(format!("the decoded size of weight {name:?} does not match its shape"))),
    }
}

fn dequantized(dtype: &str, quantization: &Option<Quantization>, stored: impl Iterator<Item = f32>) -> Data {
    let scale = quantization.as_ref().and_then(|quantization| quantization.scale).unwrap_or(1.0);
    let min = quantization.as_ref().and_then(|quantization| quantization.min).unwrap_or(0.0);
    let values = stored.map(|value| value * scale + min);
    match dtype {
        "int32" => Data::Int(values.map(|value| value.round() as i64).collect()),
        _ => Data::Float(values.collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(weight: &str, bytes: &[u8]) -> Result<Array> {
        let json = format!(
            r#"{{"modelTopology": {{}}, "weightsManifest": [{{"paths": ["a", "b"], "weights": [{weight}]}}]}}"#
        );
        let (first, second) = bytes.split_at(bytes.len() / 2);
        let mut weights = read_weights(&ModelJson::parse(json.as_bytes())?, &[first, second])?;
        Ok(weights.remove("w").unwrap())
    }

    #[test]
    fn weights_may_cross_from_one_file_into_the_next() {
        let array =
            read(r#"{"name": "w", "shape": [1], "dtype": "float32"}"#, &1.5f32.to_le_bytes()).unwrap();
        assert_eq!(array.as_floats(), Some(&[1.5][..]));
    }

    #[test]
    fn quantised_weights_are_scaled() {
        let weight = r#"{"name": "w", "shape": [2], "dtype": "float32",
            "quantization": {"dtype": "uint8", "scale": 0.5, "min": -1}}"#;
        assert_eq!(read(weight, &[0, 4]).unwrap().as_floats(), Some(&[-1.0, 1.0][..]));
        let weight = weight.replace("uint8", "uint16").replace("float32", "int32");
        assert_eq!(read(&weight, &[4, 0, 0, 1]).unwrap().as_ints(), Some(&[1, 127][..]));
    }

    #[test]
    fn sizes_are_checked_before_allocating() {
        for shape in ["[2]", "[4294967296, 4294967296]", "[18446744073709551615]"] {
            let weight = format!(r#"{{"name": "w", "shape": {shape}, "dtype": "float32"}}"#);
            let error = read(&weight, &[0; 4]).unwrap_err();
            assert_eq!(error.kind(), opendr_engine::ErrorKind::Format, "{error}");
        }
        let error = read(r#"{"name": "w", "shape": [1], "dtype": "string"}"#, &[0; 4]).unwrap_err();
        assert_eq!(error.kind(), opendr_engine::ErrorKind::Unsupported);
    }
}
