//! Conversion of targets between Python and the toolkit: as the JSON objects of `docs/json.md`, with large arrays separate.

use opendr::learner::Outputs;
use opendr::target::{Heatmap, HeatmapValues};
use opendr::{Error, Value};
use pyo3::prelude::*;

use crate::array::{ArrayMemory, NativeArray};
use crate::error::ToPython;

/// The module that writes and reads the JSON in Python.
const SCHEMA: &str = "opendr._schema";

/// One output for Python: its name, its JSON, and its array where that is too large for JSON.
pub type Payload = (&'static str, String, Option<NativeArray>);

/// Converts the outputs of one call.
pub fn payloads(outputs: &Outputs) -> opendr::Result<Vec<Payload>> {
    let named = outputs.iter().map(|(name, value)| payload(value).map(|(json, array)| (name, json, array)));
    named.collect()
}

/// Returns a target's JSON, and the array of a heatmap separately.
pub fn payload(value: &Value) -> opendr::Result<(String, Option<NativeArray>)> {
    let Value::Heatmap(map) = value else { return Ok((json(value)?, None)) };
    let array = match map.values() {
        HeatmapValues::Labels(labels) => NativeArray::from_labels(labels.clone(), map.shape()),
        HeatmapValues::Scores(scores) => NativeArray::from_scores(scores.clone(), map.shape()),
    };
    Ok((json(&Value::Heatmap(without_values(map)?))?, Some(array)))
}

/// Returns a heatmap without its values.
fn without_values(map: &Heatmap) -> opendr::Result<Heatmap> {
    let mut empty = Heatmap::from_scores(Vec::new(), &[0])?;
    empty.header.clone_from(&map.header);
    empty.classes.clone_from(&map.classes);
    empty.action.clone_from(&map.action);
    Ok(empty)
}

/// Returns the JSON of a value, the same as on every surface.
pub fn json(value: &Value) -> opendr::Result<String> {
    serde_json::to_string(&value.as_value_ref())
        .map_err(|error| Error::invalid_input("the value cannot be written as JSON").with_source(error))
}

/// Converts a target to its Python object.
pub fn python_from_target<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    py.import(SCHEMA)?.call_method1("target_from_json", payload(value).to_python(py)?)
}

/// Converts a Python target.
pub fn target_from_python(object: &Bound<'_, PyAny>) -> PyResult<Value> {
    item_or_target_from_python(object).map(|(value, _)| value)
}

/// Converts a Python target or single item. Returns the value and whether it was an item; an item becomes a list of one.
pub fn item_or_target_from_python(object: &Bound<'_, PyAny>) -> PyResult<(Value, bool)> {
    let py = object.py();
    let schema = py.import(SCHEMA)?;
    let (text, is_item): (String, bool) = schema.call_method1("dumps", (object,))?.extract()?;
    let value = value_from_json(&text).to_python(py)?;
    let Value::Heatmap(empty) = value else { return Ok((value, is_item)) };
    let memory = ArrayMemory::of(&schema.call_method1("heatmap_numbers", (object,))?)?;
    let values = if memory.is::<u32>() {
        HeatmapValues::Labels(memory.to_vec::<u32>()?.into())
    } else {
        HeatmapValues::Scores(memory.to_vec::<f32>()?.into())
    };
    let mut map = Heatmap::new(values, memory.shape()).to_python(py)?;
    (map.header, map.classes, map.action) = (empty.header, empty.classes, empty.action);
    Ok((Value::Heatmap(map), false))
}

/// Reads the JSON of a target.
pub fn value_from_json(text: &str) -> opendr::Result<Value> {
    serde_json::from_str(text)
        .map_err(|error| Error::invalid_input(format!("the JSON is not a target: {error}")))
}
