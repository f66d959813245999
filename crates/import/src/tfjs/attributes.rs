//! Parameters of TensorFlow nodes, as protobuf's JSON mapping writes them.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde_json::Value as Json;

use opendr_onnx::Kind;

/// Parameters by name. Missing ones have TensorFlow's defaults, so every reader takes one.
#[derive(Debug, Default, Deserialize)]
#[serde(transparent)]
pub struct Attributes(BTreeMap<String, Json>);

impl Attributes {
    fn field(&self, key: &str, field: &str) -> Option<&Json> {
        self.0.get(key)?.get(field)
    }

    /// An integer.
    pub fn int(&self, key: &str) -> Option<i64> {
        self.field(key, "i").and_then(int)
    }

    /// A float.
    pub fn float(&self, key: &str) -> Option<f32> {
        self.field(key, "f").and_then(Json::as_f64).map(|value| value as f32)
    }

    /// A switch; false when missing.
    pub fn flag(&self, key: &str) -> bool {
        self.field(key, "b").and_then(Json::as_bool).unwrap_or(false)
    }

    /// A string.
    pub fn text(&self, key: &str) -> Option<String> {
        self.field(key, "s").and_then(text)
    }

    /// A list of integers; empty when missing.
    pub fn ints(&self, key: &str) -> Vec<i64> {
        self.list(key, "i").iter().filter_map(int).collect()
    }

    /// A list of strings; empty when missing.
    pub fn texts(&self, key: &str) -> Vec<String> {
        self.list(key, "s").iter().filter_map(text).collect()
    }

    fn list(&self, key: &str, field: &str) -> &[Json] {
        self.field(key, "list")
            .and_then(|list| list.get(field))
            .and_then(Json::as_array)
            .map_or(&[], Vec::as_slice)
    }

    /// An element type; `None` for one that ONNX graphs of ours do not hold (strings, complex numbers).
    pub fn kind(&self, key: &str) -> Option<Kind> {
        let name = self.field(key, "type")?;
        let name = name.as_str().map_or_else(|| name.to_string(), str::to_owned);
        Some(match name.as_str() {
            "DT_FLOAT" | "DT_HALF" | "DT_DOUBLE" | "1" | "2" | "19" => Kind::Float,
            "DT_INT32" | "DT_INT64" | "DT_UINT8" | "DT_INT8" | "DT_INT16" | "DT_UINT16" => Kind::Int,
            "3" | "4" | "5" | "6" | "9" | "17" => Kind::Int,
            "DT_BOOL" | "10" => Kind::Bool,
            _ => return None,
        })
    }

    /// Dimensions, -1 where open; `None` when even their number is.
    pub fn shape(&self, key: &str) -> Option<Vec<i64>> {
        let shape = self.field(key, "shape")?;
        if shape.get("unknownRank").and_then(Json::as_bool).unwrap_or(false) {
            return None;
        }
        let dims = shape.get("dim").and_then(Json::as_array).map_or(&[][..], Vec::as_slice);
        Some(dims.iter().map(|dim| dim.get("size").and_then(int).unwrap_or(0)).collect())
    }
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
        serde_json::from_str(json).unwrap()
    }

    #[test]
    fn reads_every_form() {
        let a = attributes(
            r#"{"padding": {"s": "U0FNRQ=="}, "bytes": {"s": [86, 65]}, "n": {"i": "-3"}, "m": {"i": 4},
                "f": {"f": 0.5}, "b": {"b": true}, "T": {"type": "DT_INT32"}, "U": {"type": 1},
                "strides": {"list": {"i": ["1", 2]}}, "ops": {"list": {"s": ["Qmlhc0FkZA==", "UmVsdQ=="]}},
                "shape": {"shape": {"dim": [{"size": "-1"}, {"size": 3}]}}, "any": {"shape": {"unknownRank": true}}}"#,
        );
        assert_eq!(a.text("padding").as_deref(), Some("SAME"));
        assert_eq!(a.text("bytes").as_deref(), Some("VA"));
        assert_eq!((a.int("n"), a.int("m"), a.float("f")), (Some(-3), Some(4), Some(0.5)));
        assert!(a.flag("b") && !a.flag("missing"));
        assert_eq!((a.kind("T"), a.kind("U")), (Some(Kind::Int), Some(Kind::Float)));
        assert_eq!(a.ints("strides"), [1, 2]);
        assert_eq!(a.texts("ops"), ["BiasAdd", "Relu"]);
        assert_eq!((a.shape("shape"), a.shape("any")), (Some(vec![-1, 3]), None));
    }

    #[test]
    fn nonsense_reads_as_missing() {
        let a = attributes(r#"{"s": {"s": "%%"}, "i": {"i": {}}, "l": {"list": 3}, "n": null}"#);
        assert_eq!((a.text("s"), a.int("i"), a.ints("l"), a.float("n")), (None, None, vec![], None));
    }
}
