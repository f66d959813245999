//! The text parsers of this crate, for the fuzzers: each may refuse what it is given, none may panic.

use std::path::Path;

use crate::voc::annotation::Annotation;
use crate::yolo::{label, yaml};

/// COCO's annotation files.
pub fn coco_json(bytes: &[u8]) {
    crate::coco::index_bytes(bytes);
}

/// Pascal VOC's annotation file.
pub fn voc_xml(text: &str) {
    let _ = Annotation::new(Path::new("a.xml"), text);
}

/// YOLO's label file and `data.yaml`.
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

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use super::*;

    #[test]
    fn corpora_are_refused_or_read() {
        let corpora = Path::new(&std::env::var("CARGO_MANIFEST_DIR").unwrap()).join("../../fuzz/corpus");
        for name in ["coco_json", "voc_xml", "yolo_text"] {
            let files: Vec<_> = fs::read_dir(corpora.join(name)).unwrap().collect();
            assert!(!files.is_empty(), "{name} has an empty corpus");
            for file in files {
                let bytes = fs::read(file.unwrap().path()).unwrap();
                let text = String::from_utf8_lossy(&bytes);
                match name {
                    "coco_json" => coco_json(&bytes),
                    "voc_xml" => voc_xml(&text),
                    _ => yolo_text(&text),
                }
            }
        }
    }
}
