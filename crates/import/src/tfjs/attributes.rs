//! Parameters of TensorFlow nodes in protobuf's JSON mapping.

use std::collections::BTreeMap;

use opendr_onnx::ElementType;
use serde::{Deserialize, Deserializer};
use serde_json::Value as Json;

use crate::tensorflow::{Attribute, Attributes};

/// Reads the parameters of a node; those that the importer does not use are omitted.
///
/// # Errors
/// When the value is not an object.
pub fn deserialize<'de, D: Deserializer<'de>>(json: D) -> Result<Attributes, D::Error> {
    let parameters = BTreeMap::<String, Json>::deserialize(json)?;
    Ok(parameters.into_iter().filter_map(|(key, json)| Some((key, attribute(&json)?))).collect())
}

fn attribute(json: &Json) -> Option<Attribute> {
    let (field, json) = json.as_object()?.iter().next()?;
    match field.as_str() {
        "i" => int(json).map(Attribute::Int),
        "f" => json.as_f64().map(|value| Attribute::Float(value as f32)),
        "b" => json.as_bool().map(Attribute::Flag),
        "s" => text(json).map(Attribute::Text),
        "list" => list(json),
        "type" => kind(json).map(Attribute::Kind),
        "shape" => shape(json).map(Attribute::Shape),
        _ => None,
    }
}

fn list(json: &Json) -> Option<Attribute> {
    let of = |field: &str| json.get(field).and_then(Json::as_array);
    match (of("i"), of("s")) {
        (Some(ints), _) => Some(Attribute::Ints(ints.iter().filter_map(int).collect())),
        (_, Some(texts)) => Some(Attribute::Texts(texts.iter().filter_map(text).collect())),
        _ => None,
    }
}

/// Returns an element type; `None` for a type that the graphs do not support (strings, complex numbers).
fn kind(json: &Json) -> Option<ElementType> {
    let name = json.as_str().map_or_else(|| json.to_string(), str::to_owned);
    Some(match name.as_str() {
        "DT_FLOAT" | "DT_HALF" | "DT_DOUBLE" | "1" | "2" | "19" => ElementType::Float,
        "DT_INT32" | "DT_INT64" | "DT_UINT8" | "DT_INT8" | "DT_INT16" | "DT_UINT16" => ElementType::Int,
        "3" | "4" | "5" | "6" | "9" | "17" => ElementType::Int,
        "DT_BOOL" | "10" => ElementType::Bool,
        _ => return None,
    })
}

/// Returns dimensions, -1 where open; `None` when the rank is open.
fn shape(json: &Json) -> Option<Vec<i64>> {
    if json.get("unknownRank").and_then(Json::as_bool).unwrap_or(false) {
        return None;
    }
    let dims = json.get("dim").and_then(Json::as_array).map_or(&[][..], Vec::as_slice);
    Some(dims.iter().map(|dim| dim.get("size").and_then(int).unwrap_or(0)).collect())
}

/// 64-bit integers are written as strings.
fn int(json: &Json) -> Option<i64> {
    json.as_i64().or_else(|| json.as_str()?.parse().ok())
}
/// Strings are written in base64, by some converters as a list of bytes.
fn text(json: &Json) -> Option<String> {
    let bytes = match json {
        Json::String(encoded) => bytes_from_base64(encoded)?,
        Json::Array(bytes) => {
            bytes.iter().map(|byte| byte.as_u64().map(|byte| byte as u8)).collect::<Option<_>>()?
        }
        _ => return None,
    };
    String::from_utf8(bytes).ok()
}

fn bytes_from_base64(encoded: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(encoded.len() / 4 * 3 + 3);
    let (mut bits, mut count) = (0u32, 0);
    for symbol in encoded.bytes().filter(|&symbol| symbol != b'=') {
        let value = match symbol {
            b'A'..=b'Z' => symbol - b'A',
            b'a'..=b'z' => symbol - b'a' + 26,
            b'0'..=b'9' => symbol - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return None,
        };
        bits = bits << 6 | u32::from(value);
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn attributes(json: &str) -> Attributes {
        deserialize(&mut serde_json::Deserializer::from_str(json)).unwrap()
    }

    #[test]
    fn reads_every_form() {
        let a = attributes(
            r#"{"padding": {"s": "U0FNRQ=="}, "bytes": {"s": [86, 65]}, "n": {"i": "-3"}, "m": {"i": 4},
                "f": {"f": 0.5}, "b": {"b": true}, "T": {"type": "DT_INT32"}, "U": {"type": 1},
                "strides": {"list": {"i": ["1", 2]}}, "ops": {"list": {"s": ["Qmlhc0FkZA==", "UmVsdQ=="]}},
                "shape": {"shape": {"dim": [{"size": "-1"}, {"size": 3}]}}, "any": {"shape": {"unknownRank": true}}}"#,
        );
        assert_eq!(a.text("padding"), Some("SAME"));
        assert_eq!(a.text("bytes"), Some("VA"));
        assert_eq!((a.int("n"), a.int("m"), a.float("f")), (Some(-3), Some(4), Some(0.5)));
        assert!(a.flag("b") && !a.flag("missing"));
        assert_eq!((a.kind("T"), a.kind("U")), (Some(ElementType::Int), Some(ElementType::Float)));
        assert_eq!(a.ints("strides"), [1, 2]);
        assert_eq!(a.texts("ops"), ["BiasAdd", "Relu"]);
        assert_eq!((a.shape("shape"), a.shape("any")), (Some(&[-1, 3][..]), None));
    }

    #[test]
    fn nonsense_reads_as_missing() {
        let a = attributes(r#"{"s": {"s": "%%"}, "i": {"i": {}}, "l": {"list": 3}, "n": null}"#);
        assert_eq!((a.text("s"), a.int("i"), a.ints("l"), a.float("n")), (None, None, &[][..], None));
    }
}
