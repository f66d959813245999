//! OpenDR's texts and conversions of targets, made by the toolkit for the Python classes.

use opendr::target::{
    BoundingBox3DList, BoundingBoxList, KittiColumns, TrackingAnnotation3DList, TrackingAnnotationList,
};
use opendr::{Error, Result, Value};
use pyo3::prelude::*;

use crate::error::ToPython;
use crate::target::{json, target_from_python, value_from_json};

/// The JSON of a Python target, as every surface writes it.
#[pyfunction]
pub fn canonical_json(py: Python<'_>, target: &Bound<'_, PyAny>) -> PyResult<String> {
    json(&target_from_python(target)?).to_python(py)
}

/// OpenDR's text of a Python target; with `item` that of the first item of a list, with `readable` people's text.
#[pyfunction]
#[pyo3(signature = (target, item=false, readable=false))]
pub fn text(py: Python<'_>, target: &Bound<'_, PyAny>, item: bool, readable: bool) -> PyResult<String> {
    let value = target_from_python(target)?;
    let text = match (&value, item, readable) {
        (_, false, true) => format!("{:#}", value.as_value_ref()),
        (_, false, false) => value.as_value_ref().to_string(),
        (Value::BoundingBoxList(list), ..) => text_of_first(&list.boxes),
        (Value::BoundingBox3DList(list), ..) => text_of_first(&list.boxes),
        (Value::TrackingAnnotationList(list), ..) => text_of_first(&list.annotations),
        (Value::TrackingAnnotation3DList(list), ..) => text_of_first(&list.annotations),
        (Value::PoseList(list), ..) => text_of_first(&list.poses),
        _ => return Err(no_such(&value, "items")).to_python(py),
    };
    Ok(text)
}

fn text_of_first(items: &[impl ToString]) -> String {
    items.first().map(ToString::to_string).unwrap_or_default()
}

/// The rows of `mot()`: `[frame, left, top, width, height, confidence]`, with the id after the frame for tracks.
#[pyfunction]
#[pyo3(signature = (target, frame=None))]
pub fn mot(py: Python<'_>, target: &Bound<'_, PyAny>, frame: Option<i64>) -> PyResult<Vec<Vec<f32>>> {
    match target_from_python(target)? {
        Value::BoundingBoxList(list) => Ok(list.mot(frame).iter().map(|row| row.to_vec()).collect()),
        Value::TrackingAnnotationList(list) => Ok(list.mot().iter().map(|row| row.to_vec()).collect()),
        other => Err(no_such(&other, "mot()")).to_python(py),
    }
}

/// Tracks from rows of `mot()`, as JSON.
#[pyfunction]
pub fn from_mot(py: Python<'_>, rows: Vec<Vec<f32>>) -> PyResult<String> {
    let tracks = TrackingAnnotationList::from_mot(rows.iter().map(Vec::as_slice));
    tracks.and_then(|tracks| json(&Value::TrackingAnnotationList(tracks))).to_python(py)
}

/// The entries of `coco()`, as JSON.
#[pyfunction]
pub fn coco(py: Python<'_>, target: &Bound<'_, PyAny>, with_confidence: bool) -> PyResult<String> {
    match target_from_python(target)? {
        Value::BoundingBoxList(list) => written(&list.coco(with_confidence)).to_python(py),
        other => Err(no_such(&other, "coco()")).to_python(py),
    }
}

/// Boxes from the JSON of COCO's entries, as JSON.
#[pyfunction]
#[pyo3(signature = (entries, image_id=None))]
pub fn from_coco(py: Python<'_>, entries: &str, image_id: Option<i64>) -> PyResult<String> {
    let boxes = read::<Vec<_>>(entries).map(|entries| BoundingBoxList::from_coco(entries, image_id));
    boxes.and_then(|boxes| json(&Value::BoundingBoxList(boxes))).to_python(py)
}

/// The columns of `kitti()`, as JSON.
#[pyfunction]
pub fn kitti(py: Python<'_>, target: &Bound<'_, PyAny>, with_tracking_info: bool) -> PyResult<String> {
    let columns = match target_from_python(target)? {
        Value::BoundingBox3DList(list) => list.kitti(),
        Value::TrackingAnnotation3DList(list) => list.kitti(with_tracking_info),
        other => return Err(no_such(&other, "kitti()")).to_python(py),
    };
    written(&columns).to_python(py)
}

/// Boxes in space, or tracks when the columns say whose, from the JSON of KITTI's columns, as JSON.
#[pyfunction]
pub fn from_kitti(py: Python<'_>, columns: &str) -> PyResult<String> {
    let value = read::<KittiColumns>(columns).and_then(|columns| match columns.id {
        Some(_) => TrackingAnnotation3DList::from_kitti(&columns).map(Value::TrackingAnnotation3DList),
        None => BoundingBox3DList::from_kitti(&columns).map(Value::BoundingBox3DList),
    });
    value.and_then(|value| json(&value)).to_python(py)
}

/// Reads the JSON of a target and writes it again: whether it is one, with what was left out filled in.
#[pyfunction]
pub fn checked_json(py: Python<'_>, text: &str) -> PyResult<String> {
    value_from_json(text).and_then(|value| json(&value)).to_python(py)
}

fn no_such(value: &Value, what: &str) -> Error {
    Error::unsupported(format!("{} has no {what}", value.as_value_ref().value_type().name()))
}

fn written(value: &impl serde::Serialize) -> Result<String> {
    serde_json::to_string(value).map_err(|error| Error::internal("no JSON form").with_source(error))
}

fn read<T: serde::de::DeserializeOwned>(text: &str) -> Result<T> {
    serde_json::from_str(text).map_err(|error| Error::invalid_input(error.to_string()))
}
