//! Entry points for the fuzzers: parsers may return errors, but must not panic.

use std::path::Path;

use crate::voc::annotation::Annotation;
use crate::yolo::{label, yaml};

/// Parses a COCO annotation file.
pub fn coco_json(bytes: &[u8]) {
    crate::coco::index_bytes(bytes);
}

/// Parses a Pascal VOC annotation file.
pub fn voc_xml(text: &str) {
    let _ = Annotation::new(Path::new("a.xml"), text);
}

/// Parses a YOLO label file and `data.yaml`.
pub fn yolo_text(text: &str) {
    let _ = yaml::Keys::new(Path::new("data.yaml"), text);
    for line in text.lines() {
        if let Ok(found) = label::box_from_line(line, [640, 480], Ok) {
            assert!(found.corners().iter().all(|number| number.is_finite()));
            let _ = (
                label::line_from_box(&found, 0, [640, 480], true),
                label::line_from_box(&found, 0, [640, 480], false),
            );
        }
    }
}

/// Parses an ICDAR annotation file.
pub fn icdar_text(text: &str) {
    for line in text.lines() {
        if let Ok(region) = crate::icdar::region_from_line(line) {
            assert!(region.corners.iter().flatten().all(|number| number.is_finite()));
        }
    }
}

/// Parses a WAVE file.
pub fn wav(bytes: &[u8]) {
    if let Ok(audio) = crate::audio_from_wav(bytes) {
        assert!(audio.array().as_slice().iter().all(|sample| sample.is_finite()));
    }
}

/// Parses a NumPy `.npy` file.
pub fn npy(bytes: &[u8]) {
    if let Ok((shape, numbers)) = crate::array_from_npy(bytes) {
        assert_eq!(shape.iter().product::<usize>(), numbers.len());
    }
}

/// Parses a Python pickle.
pub fn pickle(bytes: &[u8]) {
    if let Ok(pickle) = crate::pickle::Pickle::parse(bytes) {
        let _ = pickle.root().get("pose").and_then(|pose| pose.list()?.first()?.array());
    }
}

/// Parses a WFDB header, up to the first zero byte, with its signals, and annotations.
pub fn wfdb(bytes: &[u8]) {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    let (text, rest) = bytes.split_at(end);
    let _ = crate::annotations_from_atr(rest);
    if let Ok(header) = crate::WfdbHeader::parse(&String::from_utf8_lossy(text)) {
        let _ = crate::wfdb_samples(&header.signals, header.length, rest);
    }
}

/// Parses labels of MOT and KITTI, and KITTI's calibration.
pub fn track_text(text: &str) {
    crate::mot::parse_any(text);
    crate::kitti::parse_any(text);
    let _ = crate::calibration_from_kitti(text, Path::new("calib.txt"));
}

/// Parses series of the UCR and UEA archives.
pub fn series_text(text: &str) {
    crate::ucr::parse_any(text);
}

/// Parses skeletons of NTU RGB+D.
pub fn skeleton_text(text: &str) {
    let _ = crate::skeleton_from_ntu(text);
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use super::*;

    #[test]
    fn corpora_are_refused_or_read() {
        let corpora = Path::new(&std::env::var("CARGO_MANIFEST_DIR").unwrap()).join("../../fuzz/corpus");
        for name in [
            "coco_json",
            "voc_xml",
            "yolo_text",
            "icdar_text",
            "wav",
            "npy",
            "pickle",
            "wfdb",
            "track_text",
            "series_text",
            "skeleton_text",
        ] {
            let files: Vec<_> = fs::read_dir(corpora.join(name)).unwrap().collect();
            assert!(!files.is_empty(), "{name} has an empty corpus");
            for file in files {
                let bytes = fs::read(file.unwrap().path()).unwrap();
                let text = String::from_utf8_lossy(&bytes);
                match name {
                    "coco_json" => coco_json(&bytes),
                    "voc_xml" => voc_xml(&text),
                    "yolo_text" => yolo_text(&text),
                    "icdar_text" => icdar_text(&text),
                    "wav" => wav(&bytes),
                    "npy" => npy(&bytes),
                    "pickle" => pickle(&bytes),
                    "wfdb" => wfdb(&bytes),
                    "track_text" => track_text(&text),
                    "series_text" => series_text(&text),
                    _ => skeleton_text(&text),
                }
            }
        }
    }
}
