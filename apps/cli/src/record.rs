//! What is printed of one frame: text for people, or one line of JSON (`docs/json.md`).

use std::collections::BTreeMap;
use std::fmt::Write as _;

use opendr::learner::Outputs;
use opendr::{Error, Value};
use serde::Serialize;

use crate::timings::Timings;

/// The JSON line of a frame.
#[derive(Serialize)]
pub struct Record<'a> {
    /// The file, or the device.
    pub input: &'a str,
    /// Number of the frame within its input.
    pub index: u64,
    /// The learner's outputs by name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outputs: Option<BTreeMap<&'static str, &'a Value>>,
    /// Why there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<Failure>,
    /// How long it took.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub timings_ms: Option<Timings>,
}

/// An error in a JSON line.
#[derive(Serialize)]
pub struct Failure {
    kind: &'static str,
    message: String,
}

impl From<&Error> for Failure {
    fn from(error: &Error) -> Self {
        Self { kind: error.kind().name(), message: error.to_string() }
    }
}

/// The outputs by name, as a JSON line has them.
pub fn by_name(outputs: &Outputs) -> BTreeMap<&'static str, &Value> {
    outputs.iter().collect()
}

/// The outputs as people read them, indented under the name of the frame.
pub fn text(input: &str, outputs: &Outputs, timings: Option<Timings>) -> String {
    let mut text = input.to_owned();
    if let Some(timings) = timings {
        // Writing to a String cannot fail.
        write!(text, " ({timings})").ok();
    }
    for (name, value) in outputs.iter() {
        let found = match value {
            Value::BoundingBoxList(boxes) => format!("{boxes:#}"),
            other => format!("{other:?}"),
        };
        if found.trim().is_empty() {
            write!(text, "\n  {name}: none").ok();
        }
        for line in found.lines() {
            write!(text, "\n  {line}").ok();
        }
    }
    text
}
