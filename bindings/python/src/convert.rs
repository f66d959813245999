//! OpenDR's texts and conversions of targets, for the Python classes.

use opendr::target::{
    BoundingBox3DList, BoundingBoxList, KittiColumns, TrackingAnnotation3DList, TrackingAnnotationList,
};
use opendr::{Error, Result, Value};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::ToPython;
use crate::target::{item_or_target_from_python, python_from_target, target_from_python, value_from_json};

/// Returns the JSON of a Python target, the same as on every surface.
#[pyfunction]
pub fn json(target: &Bound<'_, PyAny>) -> PyResult<String> {
    crate::target::json(&target_from_python(target)?).to_python(target.py())
}

/// Returns the Python target of a JSON object.
#[pyfunction]
#[pyo3(name = "value_from_json")]
pub fn value_from_json_text<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    python_from_target(py, &value_from_json(text).to_python(py)?)
}

/// Returns OpenDR's text of a Python target or of a single item.
#[pyfunction]
pub fn text(target: &Bound<'_, PyAny>) -> PyResult<String> {
    let (value, is_item) = item_or_target_from_python(target)?;
    Ok(match &value {
        Value::BoundingBoxList(list) if is_item => text_of_first(&list.boxes),
        Value::BoundingBox3DList(list) if is_item => text_of_first(&list.boxes),
        Value::TrackingAnnotationList(list) if is_item => text_of_first(&list.annotations),
        Value::TrackingAnnotation3DList(list) if is_item => text_of_first(&list.annotations),
        Value::PoseList(list) if is_item => text_of_first(&list.poses),
        _ => value.as_value_ref().to_string(),
    })
}

fn text_of_first(items: &[impl ToString]) -> String {
    items.first().map(ToString::to_string).unwrap_or_default()
}

/// Returns the text of a target for people, one line per item.
#[pyfunction]
pub fn readable_text(target: &Bound<'_, PyAny>) -> PyResult<String> {
    Ok(format!("{:#}", target_from_python(target)?.as_value_ref()))
}

/// Returns the rows of `mot()`: `[frame, left, top, width, height, confidence]`, with the id after the frame for tracks;
/// the confidence only `with_confidence`.
#[pyfunction]
pub fn mot(target: &Bound<'_, PyAny>, with_confidence: bool, frame: i64) -> PyResult<Vec<Vec<f32>>> {
    let mut rows: Vec<Vec<f32>> = match target_from_python(target)? {
        Value::BoundingBoxList(list) => list.mot(Some(frame)).iter().map(|row| row.to_vec()).collect(),
        Value::TrackingAnnotationList(list) => list.mot().iter().map(|row| row.to_vec()).collect(),
        other => return Err(no_such(&other, "mot()")).to_python(target.py()),
    };
    if !with_confidence {
        rows.iter_mut().for_each(|row| row.truncate(row.len().saturating_sub(1)));
    }
    Ok(rows)
}

/// Returns tracks from rows of `mot()`.
#[pyfunction]
pub fn from_mot(py: Python<'_>, rows: Vec<Vec<f32>>) -> PyResult<Bound<'_, PyAny>> {
    let tracks = TrackingAnnotationList::from_mot(rows.iter().map(Vec::as_slice)).to_python(py)?;
    python_from_target(py, &Value::TrackingAnnotationList(tracks))
}

/// Returns the entries of `coco()`.
#[pyfunction]
pub fn coco<'py>(target: &Bound<'py, PyAny>, with_confidence: bool) -> PyResult<Bound<'py, PyAny>> {
    match target_from_python(target)? {
        Value::BoundingBoxList(list) => python_from(target.py(), &list.coco(with_confidence)),
        other => Err(no_such(&other, "coco()")).to_python(target.py()),
    }
}

/// Returns boxes from COCO's entries.
#[pyfunction]
pub fn from_coco<'py>(entries: &Bound<'py, PyAny>, image_id: i64) -> PyResult<Bound<'py, PyAny>> {
    let boxes = BoundingBoxList::from_coco(from_python::<Vec<_>>(entries)?, Some(image_id));
    python_from_target(entries.py(), &Value::BoundingBoxList(boxes))
}

/// Returns the columns of `kitti()`.
#[pyfunction]
pub fn kitti<'py>(target: &Bound<'py, PyAny>, with_tracking_info: bool) -> PyResult<Bound<'py, PyAny>> {
    let columns = match target_from_python(target)? {
        Value::BoundingBox3DList(list) => list.kitti(),
        Value::TrackingAnnotation3DList(list) => list.kitti(with_tracking_info),
        other => return Err(no_such(&other, "kitti()")).to_python(target.py()),
    };
    python_from(target.py(), &columns)
}

/// Returns 3D boxes from KITTI's columns, or tracks where `ids` are given.
#[pyfunction]
#[pyo3(signature = (columns, ids=None, frames=None))]
pub fn from_kitti<'py>(
    columns: &Bound<'py, PyDict>,
    ids: Option<Vec<i64>>,
    frames: Option<Vec<i64>>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = columns.py();
    let columns = KittiColumns { id: ids, frame: frames, ..from_python(columns)? };
    let value = match columns.id {
        Some(_) => TrackingAnnotation3DList::from_kitti(&columns).map(Value::TrackingAnnotation3DList),
        None => BoundingBox3DList::from_kitti(&columns).map(Value::BoundingBox3DList),
    };
    python_from_target(py, &value.to_python(py)?)
}

fn no_such(value: &Value, what: &str) -> Error {
    Error::unsupported(format!("{} has no {what}", value.as_value_ref().value_type().name()))
}

/// Converts a serialisable value to plain Python objects, by JSON.
fn python_from<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value);
    let text: Result<_> =
        text.map_err(|error| Error::internal("the value cannot be written as JSON").with_source(error));
    py.import("json")?.call_method1("loads", (text.to_python(py)?,))
}

/// Converts plain Python objects to a deserialisable value, by JSON.
fn from_python<T: DeserializeOwned>(value: &Bound<'_, PyAny>) -> PyResult<T> {
    let text: String = value.py().import("json")?.call_method1("dumps", (value,))?.extract()?;
    let read: Result<T> =
        serde_json::from_str(&text).map_err(|error| Error::invalid_input(error.to_string()));
    read.to_python(value.py())
}
