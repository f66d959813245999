//! Bytes of an item: the length of its head in 4 bytes (little-endian), the head as JSON, then a JPEG image, points or samples.

use opendr_engine::data::{Audio, Calibration, Image, PointCloud, Timeseries};
use opendr_engine::target::LidarBox;
use opendr_engine::{Value, ValueRef};
use opendr_vision::Encoder;
use opendr_vision::draw::{Style, draw};
use serde_json::{Map, json};

use crate::Shown;
use crate::memory::resident_mb;

/// Quality of images.
const JPEG_QUALITY: u8 = 80;
/// Maximum number of points; of larger clouds, every second, third, ... point is sent.
const MAX_POINTS: usize = 150_000;
/// Maximum number of columns of a trace.
const MAX_COLUMNS: usize = 2000;
/// Maximum number of traces.
const MAX_TRACES: usize = 8;
/// Maximum length of a prediction's text in bytes.
const MAX_TEXT: usize = 4 << 10;

/// Encodes an item.
pub fn encoded(number: u64, item: &Shown, is_drawn: bool) -> Vec<u8> {
    let mut head = Map::new();
    let values = item.outputs.iter().map(|(name, value)| (name, format!("{value:#}")));
    let notes = item.notes.iter().map(|(name, text)| (name, text.clone()));
    let outputs = values.chain(notes).map(|(name, text)| json!({ "name": name, "text": shortened(text) }));
    let stages = item.stages.iter().map(|(name, time)| json!([name, time]));
    head.insert("number".to_owned(), json!(number));
    head.insert("input".to_owned(), json!(item.name));
    head.insert("index".to_owned(), json!(item.index));
    head.insert("outputs".to_owned(), outputs.collect());
    head.insert("stages_ms".to_owned(), stages.collect());
    head.insert("memory_mb".to_owned(), json!(resident_mb()));
    let (kind, body) = match image_of(&item.input) {
        Some(image) => ("image", jpeg(image, item, is_drawn)),
        None => match &item.input {
            Value::PointCloud(cloud) => ("points", points(cloud, &mut head)),
            Value::PointCloudWithCalibration(seen) => ("points", points(&seen.cloud, &mut head)),
            Value::Audio(audio) => ("traces", audio_traces(audio, &mut head)),
            Value::Timeseries(series) => ("traces", series_traces(series, &mut head)),
            _ => ("none", Vec::new()),
        },
    };
    if kind == "points" {
        head.insert("boxes".to_owned(), boxes(item).into());
    }
    head.insert("kind".to_owned(), json!(kind));
    let head = serde_json::Value::Object(head).to_string();
    let mut bytes = Vec::with_capacity(4 + head.len() + body.len());
    bytes.extend_from_slice(&(head.len() as u32).to_le_bytes());
    bytes.extend_from_slice(head.as_bytes());
    bytes.extend_from_slice(&body);
    bytes
}

/// Shortens the text of a prediction.
fn shortened(mut text: String) -> String {
    if text.len() > MAX_TEXT {
        let end = (0..=MAX_TEXT).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0);
        text.truncate(end);
        text.push_str("\n...");
    }
    text
}

fn image_of(input: &Value) -> Option<&Image> {
    match input {
        Value::Image(image) => Some(image),
        Value::ImageWithDetections(seen) => Some(&seen.image),
        _ => None,
    }
}

fn jpeg(image: &Image, item: &Shown, is_drawn: bool) -> Vec<u8> {
    let mut image = image.clone();
    if is_drawn {
        item.outputs.iter().for_each(|(_, value)| draw(&mut image, value, &Style::default()));
    }
    // An image that JPEG cannot have, more than 65,535 pixels wide, is displayed as none.
    Encoder { jpeg_quality: JPEG_QUALITY }.encode_jpeg(&image).unwrap_or_default()
}

/// Encodes points as x, y, z and intensity (0 if there is none).
fn points(cloud: &PointCloud, head: &mut Map<String, serde_json::Value>) -> Vec<u8> {
    let step = cloud.len().div_ceil(MAX_POINTS).max(1);
    head.insert("points".to_owned(), json!(cloud.len()));
    let of_point = |point: &[f32]| {
        let number = |channel: usize| point.get(channel).copied().filter(|number| number.is_finite());
        std::array::from_fn::<_, 4, _>(|channel| number(channel).unwrap_or(0.0))
    };
    cloud.points().step_by(step).flat_map(of_point).flat_map(f32::to_le_bytes).collect()
}

/// Returns the corners and the name of each box in the frame of the lidar.
fn boxes(item: &Shown) -> Vec<serde_json::Value> {
    let nominal = Calibration::nominal();
    let calibration = match &item.input {
        Value::PointCloudWithCalibration(seen) => &seen.calibration,
        _ => &nominal,
    };
    let mut boxes = Vec::new();
    for (_, value) in &item.outputs {
        match value.as_value_ref() {
            ValueRef::BoundingBox3DList(list) => boxes.extend(list.boxes.iter().filter_map(|found| {
                let name = format!("{} {:.2}", found.name, found.confidence);
                Some(json!({ "corners": LidarBox::from_camera(found, calibration)?.corners(), "name": name }))
            })),
            ValueRef::TrackingAnnotation3DList(list) => {
                boxes.extend(list.annotations.iter().filter_map(|track| {
                    let name = format!("{} {}", track.bounding_box_3d.name, track.id);
                    let corners = LidarBox::from_camera(&track.bounding_box_3d, calibration)?.corners();
                    Some(json!({ "corners": corners, "name": name }))
                }));
            }
            _ => {}
        }
    }
    boxes
}

fn audio_traces(audio: &Audio, head: &mut Map<String, serde_json::Value>) -> Vec<u8> {
    head.insert("duration_s".to_owned(), json!(audio.duration_s()));
    traces(&[audio.mono().to_vec()], head)
}

fn series_traces(series: &Timeseries, head: &mut Map<String, serde_json::Value>) -> Vec<u8> {
    let [time, features] = series.shape();
    let feature =
        |feature: usize| (0..time).filter_map(|at| series.at(at)?.get(feature).copied()).collect::<Vec<_>>();
    let features: Vec<_> = (0..features.min(MAX_TRACES)).map(feature).collect();
    traces(&features, head)
}

/// Encodes the minimum and the maximum of each column of each trace.
fn traces(traces: &[Vec<f32>], head: &mut Map<String, serde_json::Value>) -> Vec<u8> {
    let length = traces.first().map_or(0, Vec::len);
    let per_column = length.div_ceil(MAX_COLUMNS).max(1);
    head.insert("traces".to_owned(), json!(traces.len()));
    head.insert("samples".to_owned(), json!(length));
    let column = |samples: &[f32]| {
        let finite = || samples.iter().copied().filter(|sample| sample.is_finite());
        let (low, high) =
            (finite().fold(f32::INFINITY, f32::min), finite().fold(f32::NEG_INFINITY, f32::max));
        if low <= high { [low, high] } else { [0.0; 2] }
    };
    let columns = traces.iter().flat_map(|trace| trace.chunks(per_column));
    columns.flat_map(column).flat_map(f32::to_le_bytes).collect()
}
