// What every fuzz target feeds, shared with the test that replays the corpora (`crates/opendr/tests/suite/corpus.rs`).

use opendr_bags::{Bag, Selection};
use opendr_engine::Value;
use opendr_engine::data::Image;
use opendr_engine::model::Manifest;
use opendr_engine::target::{BoundingBox3DList, TrackingAnnotationList};
use opendr_metrics::coco::files::{CocoFiles, CocoKind};
use opendr_odometry::{Alignment, KITTI_LENGTHS, Trajectory, absolute_errors, kitti_drift, relative_errors};

/// A parser of bytes from outside: it may refuse them, it may not panic.
pub type Parser = fn(&[u8]);

/// Every parser by the name of its target and corpus.
pub const PARSERS: [(&str, Parser); 31] = [
    ("manifest_json", manifest_json),
    ("tfjs_json", tfjs_json),
    ("tflite", tflite),
    ("ncnn", ncnn),
    ("ctranslate2", ctranslate2),
    ("safetensors", safetensors),
    ("card_toml", card_toml),
    ("picture", picture),
    ("target_json", target_json),
    ("label_text", label_text),
    ("coco_files", coco_files),
    ("coco_json", coco_json),
    ("voc_xml", voc_xml),
    ("yolo_text", yolo_text),
    ("icdar_text", icdar_text),
    ("wav", wav),
    ("npy", npy),
    ("pickle", pickle),
    ("wfdb", wfdb),
    ("track_text", track_text),
    ("series_text", series_text),
    ("skeleton_text", skeleton_text),
    ("optuna_journal", optuna_journal),
    ("optuna_sqlite", optuna_sqlite),
    ("xml_rpc", opendr_ros1::fuzzing::xml_rpc),
    ("tcpros_header", opendr_ros1::fuzzing::tcpros_header),
    ("bag1", recording),
    ("mcap", recording),
    ("parquet", parquet),
    ("onnx", opendr_executor::fuzzing::model),
    ("trajectory_text", trajectory_text),
];

/// Trajectories in the formats of TUM and KITTI. What was read is written and read again, and compared with itself.
fn trajectory_text(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    if let Ok(trajectory) = Trajectory::from_tum(&text) {
        assert_eq!(Trajectory::from_tum(&trajectory.to_tum()).unwrap().len(), trajectory.len());
        if let Ok((truth, estimate)) = trajectory.associated(&trajectory, 0.01) {
            absolute_errors(&truth, &estimate, Alignment::Scaled).ok();
            relative_errors(&truth, &estimate, 1).ok();
        }
    }
    if let Ok(trajectory) = Trajectory::from_kitti(&text, 10.0) {
        assert_eq!(Trajectory::from_kitti(&trajectory.to_kitti(), 10.0).unwrap().len(), trajectory.len());
        kitti_drift(&trajectory, &trajectory, &KITTI_LENGTHS).ok();
    }
}

/// A table of a data set of LeRobot.
fn parquet(bytes: &[u8]) {
    drop(opendr_lerobot::columns_of_bytes(bytes.to_vec()));
}

fn manifest_json(bytes: &[u8]) {
    let Ok(manifest) = Manifest::from_json(bytes) else { return };
    // OpenDR's own files state no checksums; what they say cannot be written as ours.
    if manifest.files.iter().all(|file| file.size.is_some() && file.sha256.is_some()) {
        let json = manifest.to_json().unwrap();
        assert_eq!(Manifest::from_json(&json).unwrap(), manifest);
    }
}

/// The JSON up to the first zero byte; the rest is the weights.
fn tfjs_json(bytes: &[u8]) {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    let weights = bytes.get(end + 1..).unwrap_or_default();
    if let Ok(onnx) = opendr_import::onnx_from_tfjs(&bytes[..end], &[weights], &Default::default()) {
        assert!(!onnx.is_empty());
    }
}

fn tflite(bytes: &[u8]) {
    if let Ok(onnx) = opendr_import::onnx_from_tflite(bytes, &Default::default()) {
        assert!(!onnx.is_empty());
    }
}

/// The layers up to the first zero byte; the rest is the weights.
fn ncnn(bytes: &[u8]) {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    let weights = bytes.get(end + 1..).unwrap_or_default();
    if let Ok(onnx) = opendr_import::onnx_from_ncnn(&bytes[..end], weights, &Default::default()) {
        assert!(!onnx.is_empty());
    }
}

fn ctranslate2(bytes: &[u8]) {
    if let Ok(networks) = opendr_import::whisper_from_ctranslate2(bytes) {
        assert!(!networks.encoder.is_empty() && !networks.decoder.is_empty());
    }
}

fn safetensors(bytes: &[u8]) {
    if let Ok(file) = opendr_import::SafetensorsFile::read(bytes) {
        for tensor in file.floats() {
            assert_eq!(tensor.float_type.decode(tensor.bytes).len(), tensor.dims.iter().product::<usize>());
        }
    }
    if let Ok(networks) = opendr_import::whisper_from_safetensors(bytes) {
        assert!(!networks.encoder.is_empty() && !networks.decoder.is_empty());
    }
}

fn card_toml(bytes: &[u8]) {
    if let Ok(text) = std::str::from_utf8(bytes) {
        opendr_zoo::Card::from_toml(text).ok();
    }
}

fn picture(bytes: &[u8]) {
    let decoder = opendr_vision::Decoder { max_samples: 1 << 20 };
    if let Ok(image) = decoder.decode(bytes) {
        assert_eq!(image.pixels().len(), image.width() * image.height() * Image::channels(&image));
    }
}

fn target_json(bytes: &[u8]) {
    if let Ok(value) = serde_json::from_slice::<Value>(bytes) {
        let json = serde_json::to_string(&value).unwrap();
        let again: Value = serde_json::from_str(&json).unwrap();
        assert_eq!(serde_json::to_string(&again).unwrap(), json);
        let _ = (format!("{}", value.as_value_ref()), format!("{:#}", value.as_value_ref()));
    }
}

fn label_text(bytes: &[u8]) {
    if let Ok(text) = std::str::from_utf8(bytes) {
        TrackingAnnotationList::from_mot_text(text).ok();
        BoundingBox3DList::from_kitti_text(text).ok();
    }
}

/// What is compared by the first byte, the annotations up to the first zero byte, then the results.
fn coco_files(bytes: &[u8]) {
    let [kind, texts @ ..] = bytes else { return };
    let kind = [CocoKind::Boxes, CocoKind::Masks, CocoKind::Keypoints][usize::from(*kind) % 3];
    let end = texts.iter().position(|byte| *byte == 0).unwrap_or(texts.len());
    let results = texts.get(end + 1..).unwrap_or_default();
    let files = CocoFiles { threads: 1, ..CocoFiles::new(kind) };
    if let Ok(done) = files.compare_readers(&texts[..end], results) {
        assert!(
            done.outcome.stats().iter().all(|number| *number == -1.0 || (0.0..=1.0 + 1e-9).contains(number))
        );
        done.report();
    }
}

fn coco_json(bytes: &[u8]) {
    opendr_datasets::fuzzing::coco_json(bytes);
}

fn voc_xml(bytes: &[u8]) {
    opendr_datasets::fuzzing::voc_xml(&String::from_utf8_lossy(bytes));
}

fn icdar_text(bytes: &[u8]) {
    opendr_datasets::fuzzing::icdar_text(&String::from_utf8_lossy(bytes));
}

fn yolo_text(bytes: &[u8]) {
    opendr_datasets::fuzzing::yolo_text(&String::from_utf8_lossy(bytes));
}

fn wav(bytes: &[u8]) {
    opendr_datasets::fuzzing::wav(bytes);
}

fn npy(bytes: &[u8]) {
    opendr_datasets::fuzzing::npy(bytes);
}

fn pickle(bytes: &[u8]) {
    opendr_datasets::fuzzing::pickle(bytes);
}

fn wfdb(bytes: &[u8]) {
    opendr_datasets::fuzzing::wfdb(bytes);
}

fn track_text(bytes: &[u8]) {
    opendr_datasets::fuzzing::track_text(&String::from_utf8_lossy(bytes));
}

fn series_text(bytes: &[u8]) {
    opendr_datasets::fuzzing::series_text(&String::from_utf8_lossy(bytes));
}

fn skeleton_text(bytes: &[u8]) {
    opendr_datasets::fuzzing::skeleton_text(&String::from_utf8_lossy(bytes));
}

fn optuna_journal(bytes: &[u8]) {
    opendr_tuning::Storage::from_journal_bytes(bytes).ok();
}

fn optuna_sqlite(bytes: &[u8]) {
    opendr_tuning::Storage::from_sqlite_bytes(bytes).ok();
}

/// Every format that is read from memory, by its first bytes.
fn recording(bytes: &[u8]) {
    let Ok(bag) = Bag::from_bytes(bytes.to_vec()) else { return };
    assert_eq!(bag.channels().len(), bag.message_counts().len());
    for in_file_order in [false, true] {
        let messages = bag.select(&Selection { in_file_order, ..Selection::default() }).unwrap();
        for message in messages.take(1000).flatten() {
            assert!(message.channel < bag.channels().len());
        }
    }
}

/// Feeds the parser called `name`.
#[allow(dead_code)]
pub fn run(name: &str, bytes: &[u8]) {
    PARSERS.iter().filter(|(parser, _)| *parser == name).for_each(|(_, parse)| parse(bytes));
}
