use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use serde_json::{Value, json};

use super::*;
use crate::params::ParamValue;
use crate::{ErrorKind, Task};

/// A new empty folder, removed with its contents at the end of the test.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        static COUNTER: AtomicU32 = AtomicU32::new(0);
        let count = COUNTER.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("opendr-model-{}-{count}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn join(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        fs::write(self.join(name), bytes).unwrap();
        self.join(name)
    }

    /// The names in the folder, in order.
    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn manifest() -> Manifest {
    let mut manifest = Manifest::new("nanodet", "coco_416");
    manifest.task = Some(Task::ObjectDetection2d);
    manifest.params.insert("threshold".into(), ParamValue::Float(0.4));
    manifest.classes = ["person", "bicycle"].into_iter().collect();
    manifest.inputs.insert("size".into(), json!([416, 416]));
    manifest.licence.weights = "Apache-2.0".into();
    manifest.licence.commercial = Some(true);
    manifest.metrics.insert("coco128".into(), json!({"map50": 0.476}));
    manifest
}

fn written(path: &Path) -> Model {
    let mut writer = ModelWriter::new(path, manifest()).unwrap();
    writer.add("model.onnx", b"network").unwrap();
    writer.add("extra/labels.txt", b"labels").unwrap();
    writer.finish().unwrap()
}

fn kind_of<T: std::fmt::Debug>(result: Result<T>) -> ErrorKind {
    result.unwrap_err().kind()
}

#[test]
fn folder_json_and_zip_read_the_same() {
    let folder = Folder::new();
    let model = written(&folder.join("model"));
    let zipped = written(&folder.join("model.zip"));
    let by_json = Model::open(folder.join("model/model.json")).unwrap();
    for opened in [&model, &zipped, &by_json] {
        assert_eq!(opened.manifest(), model.manifest());
        assert_eq!(opened.onnx().unwrap(), b"network");
        assert_eq!(opened.file("extra/labels.txt").unwrap(), b"labels");
        assert_eq!(opened.params()["threshold"], ParamValue::Float(0.4));
        assert_eq!(opened.classes().index("bicycle"), Some(1));
    }
    assert_eq!(model.manifest().files.len(), 2);
    assert_eq!(Manifest { files: Vec::new(), ..model.manifest().clone() }, manifest());
    assert_eq!(folder.names(), ["model", "model.zip"], "nothing temporary is left");
}

#[test]
fn writer_replaces_models_only_and_leaves_nothing_when_dropped() {
    let folder = Folder::new();
    written(&folder.join("model"));
    let mut writer = ModelWriter::new(folder.join("model"), Manifest::new("yunet", "")).unwrap();
    writer.add("new.onnx", b"new").unwrap();
    assert_eq!(kind_of(writer.add("NEW.onnx", b"new")), ErrorKind::InvalidInput);
    assert_eq!(kind_of(writer.add("model.json", b"{}")), ErrorKind::InvalidInput);
    assert_eq!(kind_of(writer.add("../../x", b"x")), ErrorKind::Integrity);
    assert_eq!(writer.finish().unwrap().onnx().unwrap(), b"new");
    assert!(!folder.join("model/model.onnx").exists(), "the old model is gone whole");

    let mut dropped = ModelWriter::new(folder.join("other"), manifest()).unwrap();
    dropped.add("model.onnx", b"network").unwrap();
    drop(dropped);
    assert_eq!(folder.names(), ["model"]);

    fs::create_dir(folder.join("photos")).unwrap();
    folder.write("photos/holiday.jpg", b"dear");
    assert_eq!(kind_of(ModelWriter::new(folder.join("photos"), manifest())), ErrorKind::InvalidInput);
}

#[test]
fn damage_is_detected() {
    let folder = Folder::new();
    let path = folder.join("model");
    let model = written(&path);
    fs::write(path.join("model.onnx"), b"netwOrk").unwrap();
    let error = model.file("model.onnx").unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Integrity);
    assert!(error.to_string().contains("sha256"), "{error}");
    fs::write(path.join("model.onnx"), b"networks").unwrap();
    let error = model.file("model.onnx").unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Integrity);
    assert!(error.to_string().contains("8 bytes instead of 7"), "{error}");
    fs::remove_file(path.join("model.onnx")).unwrap();
    assert_eq!(kind_of(model.file("model.onnx")), ErrorKind::NotFound);
    assert_eq!(kind_of(model.file("other.onnx")), ErrorKind::NotFound);
    assert_eq!(kind_of(Model::open(folder.join("none"))), ErrorKind::NotFound);
}

#[test]
fn one_flipped_byte_in_a_zip_is_detected() {
    let folder = Folder::new();
    written(&folder.join("model.zip"));
    let mut bytes = fs::read(folder.join("model.zip")).unwrap();
    let at = bytes.windows(7).position(|window| window == b"network").unwrap();
    bytes[at] ^= 1;
    let model = Model::open(folder.write("flipped.zip", bytes)).unwrap();
    assert_eq!(kind_of(model.onnx()), ErrorKind::Integrity);
}

#[test]
fn false_sizes_are_rejected_before_memory_is_allocated() {
    let folder = Folder::new();
    let file = |size: u64, name: &str| {
        json!({"format_version": 1, "files": [{"name": name, "size": size, "sha256": "00".repeat(32)}]})
            .to_string()
    };
    folder.write("model.onnx", b"network");
    for size in [u64::MAX, 1 << 40, 1 << 30] {
        let model = Model::open(folder.write("model.json", file(size, "model.onnx"))).unwrap();
        assert!(matches!(kind_of(model.onnx()), ErrorKind::Integrity | ErrorKind::Format), "{size}");
    }
    for name in ["../../x", "/etc/passwd", "C:\\x", ""] {
        assert_eq!(
            kind_of(Model::open(folder.write("model.json", file(1, name)))),
            ErrorKind::Integrity,
            "{name}"
        );
    }
    let huge = fs::File::create(folder.join("huge.json")).unwrap();
    huge.set_len(MAX_MANIFEST_BYTES + 1).unwrap();
    let error = Model::open(folder.join("huge.json")).unwrap_err();
    assert!(error.to_string().contains("more than 16777216 bytes"), "{error}");
}

#[cfg(unix)]
#[test]
fn link_out_of_the_folder_is_rejected() {
    let folder = Folder::new();
    written(&folder.join("model"));
    folder.write("secret", b"network");
    fs::remove_file(folder.join("model/model.onnx")).unwrap();
    std::os::unix::fs::symlink("../secret", folder.join("model/model.onnx")).unwrap();
    assert_eq!(kind_of(Model::open(folder.join("model")).unwrap().onnx()), ErrorKind::Integrity);
}

#[test]
fn other_versions_and_other_json() {
    let read = |value: Value| Manifest::from_json(value.to_string().as_bytes());
    let manifest = read(json!({"format_version": 1, "from_the_future": [1], "licence": {"new": 1}})).unwrap();
    assert_eq!(manifest, Manifest::new("", ""));
    let error = read(json!({"format_version": 2, "files": "now a text"})).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    assert!(error.to_string().contains("update OpenDR"), "{error}");
    let digest = "00".repeat(32);
    for wrong in [
        json!({}),
        json!([]),
        json!({"format_version": 0}),
        json!({"format_version": "1"}),
        json!({"format_version": 1, "task": "cooking"}),
        json!({"format_version": 1, "files": [{"name": "a"}]}),
        json!({"format_version": 1, "files": [
            {"name": "a", "size": 1, "sha256": &digest}, {"name": "A", "size": 1, "sha256": &digest}
        ]}),
    ] {
        assert_eq!(kind_of(read(wrong.clone())), ErrorKind::Format, "{wrong}");
    }
    let deep = "[".repeat(100_000);
    assert_eq!(kind_of(Manifest::from_json(deep.as_bytes())), ErrorKind::Format);
}

#[test]
fn zip_of_a_folder_and_zip_without_a_model() {
    let folder = Folder::new();
    let pack = |name: &str, entries: &[(&str, &[u8])]| {
        let mut archive = zip::ZipWriter::new(fs::File::create(folder.join(name)).unwrap());
        for (entry, bytes) in entries {
            archive.start_file(*entry, zip::write::SimpleFileOptions::default()).unwrap();
            archive.write_all(bytes).unwrap();
        }
        archive.finish().unwrap();
        folder.join(name)
    };
    let mut manifest = manifest();
    manifest.files =
        vec![ModelFile { name: "a.onnx".into(), size: Some(1000), sha256: Some(Sha256::of(&[7; 1000])) }];
    let json = manifest.to_json().unwrap();
    let nested =
        pack("nested.zip", &[("my/model.json", &json), ("my/a.onnx", &[7; 1000]), ("x/y/model.json", b"")]);
    assert_eq!(Model::open(nested).unwrap().onnx().unwrap(), [7; 1000]);
    assert_eq!(kind_of(Model::open(pack("empty.zip", &[("a", b"")]))), ErrorKind::Format);
    let garbage = Model::open(folder.write("garbage.zip", b"PK\x03\x04 and nothing more"));
    assert_eq!(kind_of(garbage), ErrorKind::Format);
}

#[test]
fn opendr_json_with_onnx_is_read() {
    let folder = Folder::new();
    folder.write("nanodet_m.onnx", b"network");
    let metadata = |paths: Value, format: &str| {
        json!({
            "model_paths": paths, "framework": "pytorch", "format": format, "has_data": false, "optimized": true,
            "inference_params": {"input_size": [416, 416], "classes": ["person", "cat"], "conf_threshold": 0.35},
            "optimizer_info": {}, "backbone": "mobilenet"
        })
    };
    for paths in [json!(["nanodet_m.onnx"]), json!("nanodet_m.onnx"), json!("/home/me/saved/nanodet_m.onnx")]
    {
        folder.write("nanodet_m.json", metadata(paths, "onnx").to_string());
        let model = Model::open(&folder.0).unwrap();
        assert_eq!(model.onnx().unwrap(), b"network");
        assert_eq!(model.file("model.onnx").unwrap(), b"network");
        assert!(model.file("iris.onnx").unwrap_err().to_string().contains("it has nanodet_m.onnx"));
        assert_eq!(model.classes().iter().collect::<Vec<_>>(), ["person", "cat"]);
        assert_eq!(model.params()["conf_threshold"], ParamValue::Float(0.35));
        assert_eq!(model.params()["backbone"], ParamValue::Text("mobilenet".into()));
        assert!(model.check_learner("nanodet").is_ok());
    }
    let read = |value: Value| Manifest::from_json(value.to_string().as_bytes());
    let error = read(metadata(json!(["nanodet_m.pth"]), "pth")).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    assert!(error.to_string().contains("optimize()"), "{error}");
    assert!(read(metadata(json!("model.onnx"), "pth")).is_ok(), "CoTransEnc writes \"pth\" for ONNX");
    assert_eq!(kind_of(read(metadata(json!(["a/.."]), "onnx"))), ErrorKind::Integrity);
    assert_eq!(kind_of(read(metadata(json!([]), "onnx"))), ErrorKind::Format);
    assert_eq!(kind_of(read(metadata(json!(3), "onnx"))), ErrorKind::Format);
}

#[test]
fn model_of_another_learner_is_rejected() {
    let folder = Folder::new();
    let model = written(&folder.join("model"));
    assert!(model.check_learner("nanodet").is_ok());
    assert_eq!(kind_of(model.check_learner("yunet")), ErrorKind::InvalidInput);
}

/// A recogniser with a detector as a part, which has a landmark network as a part.
fn with_parts(folder: &Folder, path: &str) -> Model {
    let mut writer = ModelWriter::new(folder.join("landmarks"), Manifest::new("landmarks", "")).unwrap();
    writer.add("model.onnx", b"points").unwrap();
    let landmarks = writer.finish().unwrap();
    let mut writer = ModelWriter::new(folder.join("detector.zip"), Manifest::new("yunet", "320")).unwrap();
    writer.add("model.onnx", b"boxes").unwrap();
    writer.add_part("landmarks", &landmarks).unwrap();
    let detector = writer.finish().unwrap();
    let mut writer = ModelWriter::new(folder.join(path), manifest()).unwrap();
    writer.add("model.onnx", b"embedding").unwrap();
    writer.add_part("detector", &detector).unwrap();
    writer.finish().unwrap()
}

#[test]
fn parts_are_models_in_folders_and_zips() {
    let folder = Folder::new();
    for path in ["whole", "whole.zip"] {
        let whole = with_parts(&folder, path);
        assert_eq!(whole.parts().collect::<Vec<_>>(), ["detector"]);
        assert_eq!(whole.onnx().unwrap(), b"embedding", "the networks of parts are not its own");
        let detector = whole.part("detector").unwrap();
        assert_eq!(detector.manifest().learner, "yunet");
        assert_eq!(detector.onnx().unwrap(), b"boxes");
        assert_eq!(detector.part("landmarks").unwrap().onnx().unwrap(), b"points");
        assert_eq!(whole.part("detector/landmarks").unwrap().onnx().unwrap(), b"points");
        assert_eq!(detector.path(), folder.join(path).join("detector"));

        let error = whole.part("embedder").unwrap_err();
        assert_eq!(error.kind(), ErrorKind::NotFound);
        assert!(error.to_string().contains("\"embedder\"; it contains detector"), "{error}");
        for name in ["", "..", "../detector", "/detector", "detector/../detector", "detector/"] {
            assert_eq!(kind_of(whole.part(name)), ErrorKind::Integrity, "{name:?}");
        }
    }
    let detector = Model::open(folder.join("whole/detector")).unwrap();
    assert_eq!(detector.onnx().unwrap(), b"boxes", "a part is a container of its own");
}

#[test]
fn damaged_part_is_detected() {
    let folder = Folder::new();
    let whole = with_parts(&folder, "whole");
    fs::write(folder.join("whole/detector/model.onnx"), b"b0xes").unwrap();
    assert_eq!(kind_of(whole.part("detector").unwrap().onnx()), ErrorKind::Integrity);
    assert_eq!(kind_of(whole.file("detector/model.onnx")), ErrorKind::Integrity);
    let json = fs::read_to_string(folder.join("whole/detector/model.json")).unwrap();
    fs::write(folder.join("whole/detector/model.json"), json.replace("yunet", "yumet")).unwrap();
    assert_eq!(kind_of(whole.part("detector")), ErrorKind::Integrity);

    // OpenDR's JSON would name a file without a checksum.
    let mut writer = ModelWriter::new(folder.join("old"), manifest()).unwrap();
    let json = br#"{"model_paths": ["a.onnx"], "framework": "pytorch", "format": "onnx"}"#;
    writer.add("detector/model.json", json).unwrap();
    assert_eq!(kind_of(writer.finish().unwrap().part("detector")), ErrorKind::Format);
}

#[test]
fn replaced_file_of_a_part_is_updated_in_its_manifest() {
    let folder = Folder::new();
    let whole = with_parts(&folder, "whole");
    let mut writer = ModelWriter::new(folder.join("smaller.zip"), whole.manifest().clone()).unwrap();
    for file in &whole.manifest().files {
        let bytes = if file.name == "detector/landmarks/model.onnx" {
            b"int8".to_vec()
        } else {
            whole.file(&file.name).unwrap()
        };
        writer.add(&file.name, &bytes).unwrap();
    }
    let detector = writer.finish().unwrap().part("detector").unwrap();
    assert_eq!(detector.onnx().unwrap(), b"boxes");
    assert_eq!(detector.file("landmarks/model.onnx").unwrap(), b"int8");
    assert_eq!(detector.part("landmarks").unwrap().onnx().unwrap(), b"int8");
}
