//! JSON as Python writes and reads it, with `NaN`, `Infinity` and `-Infinity`.

use opendr_engine::{Error, Result};
use serde_json::Value;

/// Prefix of a string that stands for a non-JSON number; from Unicode's private use area.
const MARK: char = '\u{e0f7}';
const NAMES: [&str; 3] = ["NaN", "-Infinity", "Infinity"];

/// Parses a value; non-JSON numbers become strings for [`number_from_value`].
pub fn value_from_text(text: &str) -> Result<Value> {
    let read = |text: &str| {
        serde_json::from_str(text).map_err(|error| Error::format("invalid JSON").with_source(error))
    };
    // Few texts contain such numbers; the others parse directly.
    match read(text) {
        Err(_) if NAMES.iter().any(|name| text.contains(name)) => read(&marked(text)),
        result => result,
    }
}

/// Returns a value as text, in one line.
pub fn text_from_value(value: &Value) -> String {
    let mut text = value.to_string();
    if text.contains(MARK) {
        for name in NAMES {
            text = text.replace(&format!("\"{MARK}{name}\""), name);
        }
    }
    text
}

/// Returns a number as a value.
pub fn value_from_number(number: f64) -> Value {
    match serde_json::Number::from_f64(number) {
        Some(number) => Value::Number(number),
        None if number.is_nan() => Value::String(format!("{MARK}NaN")),
        None => Value::String(format!("{MARK}{}", if number > 0.0 { "Infinity" } else { "-Infinity" })),
    }
}

/// Returns the number of a value, if it is one.
pub fn number_from_value(value: &Value) -> Option<f64> {
    match value {
        Value::Number(number) => number.as_f64(),
        Value::String(text) => match text.strip_prefix(MARK)? {
            "NaN" => Some(f64::NAN),
            "Infinity" => Some(f64::INFINITY),
            "-Infinity" => Some(f64::NEG_INFINITY),
            _ => None,
        },
        _ => None,
    }
}

/// Replaces non-JSON numbers outside of strings by strings.
fn marked(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 64);
    let (mut rest, mut in_string) = (text, false);
    while let Some(first) = rest.chars().next() {
        let name = NAMES.iter().find(|name| !in_string && rest.starts_with(**name));
        let length = match name {
            Some(name) => {
                out.extend(['"', MARK]);
                out.push_str(name);
                out.push('"');
                name.len()
            }
            None => {
                let escaped = in_string && first == '\\';
                in_string ^= first == '"';
                let after = rest.chars().nth(1).filter(|_| escaped).map_or(0, char::len_utf8);
                let length = first.len_utf8() + after;
                out.push_str(rest.get(..length).unwrap_or_default());
                length
            }
        };
        rest = rest.get(length..).unwrap_or_default();
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn non_json_numbers_round_trip() {
        let text = r#"{"a":[NaN,-Infinity,1.5,Infinity],"b":"NaN \" Infinity"}"#;
        let value = value_from_text(text).unwrap();
        let numbers: Vec<f64> =
            value["a"].as_array().unwrap().iter().map(|value| number_from_value(value).unwrap()).collect();
        assert!(numbers[0].is_nan() && numbers[1..] == [f64::NEG_INFINITY, 1.5, f64::INFINITY]);
        assert_eq!(value["b"], json!("NaN \" Infinity"));
        assert_eq!(text_from_value(&value), text);
        assert_eq!(text_from_value(&value_from_number(f64::NEG_INFINITY)), "-Infinity");
        assert_eq!(number_from_value(&json!("NaN")), None);
    }

    #[test]
    fn invalid_json_is_refused() {
        for wrong in ["", "{", "NaNa", "[Infinity", "\"Na", "{NaN:1}x", "\\NaN", "\"\\"] {
            assert!(value_from_text(wrong).is_err(), "{wrong}");
        }
    }
}
