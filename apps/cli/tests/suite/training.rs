//! `opendr fit` and `opendr export` as commands, with the test learner.

use std::fs;
use std::path::Path;

use crate::place::{Done, Place};
use serde_json::{Value, json};

/// A place with a data set of two splits, where sample `n` has `n` boxes; prints a line and returns `None` without the test
/// learner.
fn place() -> Option<Place> {
    let place = Place::new();
    if place.run(["fit", "counter", "--help"]).code != 0 {
        println!("skipped: built without the feature test-learner of opendr");
        return None;
    }
    place.write("data/data.yaml", "train: images/train\nval: images/val\nnames: [cat, dog]\n");
    for (part, count) in [("train", 4), ("val", 6)] {
        for at in 0..count {
            let picture = place.write(&format!("data/images/{part}/{at}.png"), "");
            image::RgbImage::new(8, 8).save(picture).unwrap();
            place.write(&format!("data/labels/{part}/{at}.txt"), "1 0.5 0.5 0.25 0.25\n".repeat(at));
        }
    }
    Some(place)
}

fn fit(place: &Place, flags: &[&str]) -> Done {
    place.run(["fit", "counter", "data", "--json"].iter().chain(flags))
}

fn report(done: Done) -> Value {
    serde_json::from_str(&done.ends_with(0).stdout).unwrap()
}

#[test]
fn a_learner_is_trained_and_measured() {
    let Some(place) = place() else { return };
    let done = fit(&place, &["--epochs", "3", "--lr=2", "--out", "run", "--val-split", "val"]);
    assert!(done.stderr.contains("training on the split \"train\" of data"), "{}", done.stderr);
    let fitted = report(done);
    assert_eq!(fitted["curves"], json!({"loss": [3.0, 3.0, 3.0], "val_boxes": [2.5]}));
    assert_eq!(fitted["model"], "run/model");
    assert_eq!(fitted["logging_path"], "run/log");
    let written: Value = serde_json::from_slice(&fs::read(place.path("run/report.json")).unwrap()).unwrap();
    assert_eq!(written["curves"], fitted["curves"]);
    let table = place.run(["fit", "counter", "data", "--limit", "2", "-q"]).ends_with(0).stdout;
    assert!(
        table.contains("trained on 2 samples of data") && table.contains("model: runs/counter-"),
        "{table}"
    );
}

#[test]
fn a_training_is_resumed_and_never_overwritten() {
    let Some(place) = place() else { return };
    report(fit(&place, &["--out", "run"]));
    let refused = fit(&place, &["--out", "run"]).ends_with(11);
    assert!(refused.stderr.contains("run is not empty: resume"), "{}", refused.stderr);
    let resumed = report(fit(&place, &["--out", "run", "--resume", "--epochs", "2"]));
    assert_eq!(resumed["curves"]["loss"], json!([1.5, 1.5]));
    let nothing = fit(&place, &["--resume"]).ends_with(13);
    assert!(nothing.stderr.contains("there is no run of counter in runs to resume"), "{}", nothing.stderr);
    let first = report(fit(&place, &[]));
    let last = report(fit(&place, &["--resume", "--epochs", "3"]));
    assert_eq!((&last["output"], last["curves"]["loss"].as_array().unwrap().len()), (&first["output"], 3));
}

#[test]
fn a_model_is_exported() {
    let Some(place) = place() else { return };
    report(fit(&place, &["--out", "run"]));
    let export = |source: &str, output: &str, flags: &[&str]| {
        place.run(["export", source, "--out", output].iter().chain(flags))
    };
    assert_eq!(export("run/model", "mine", &["--zip"]).ends_with(0).stdout, "mine.zip\n");
    export("mine.zip", "folder", &[]).ends_with(0);
    let same = |name: &str| {
        let read = |folder: &str| fs::read(place.path(Path::new(folder).join(name))).unwrap();
        assert_eq!(read("folder"), read("run/model"), "{name}");
    };
    same("model.json");
    same("bias.bin");
    assert!(export("run/model", "a.onnx", &[]).ends_with(13).stderr.contains("names no ONNX file"));
    assert!(export("nonsense", "a.onnx", &[]).ends_with(13).stderr.contains("no learner \"nonsense\""));
    assert!(export("run/model", "data", &[]).ends_with(11).stderr.contains("is not a model"));
    let from = report(fit(&place, &["--out", "again", "--model", "folder"]));
    assert_eq!(from["complete"], true);
}

#[test]
fn the_bare_network_is_exported() {
    let Some((place, _)) = Place::with_data() else { return };
    place.run(["export", "yunet/320", "--out", "yunet.onnx", "-q"]).ends_with(0);
    assert!(fs::metadata(place.path("yunet.onnx")).unwrap().len() > 100_000);
}

#[test]
fn a_model_is_converted_to_fp16() {
    let Some((place, data)) = Place::with_data() else { return };
    let done = place.run(["optimize", "yunet/320", "--fp16", "--out", "half", "--json", "-q"]).ends_with(0);
    let report: Value = serde_json::from_str(&done.stdout).unwrap();
    let [before, after] = [0, 1].map(|at| report["bytes"][at].as_f64().unwrap());
    assert!(report["precision"] == "fp16" && after < 0.6 * before, "{report}");
    let photo = data.join("data/photos/zidane.jpg");
    let faces = |flags: &[&str]| {
        let found =
            place.run(["infer", "yunet/320", photo.to_str().unwrap(), "--json", "-q"].iter().chain(flags));
        found.ends_with(0).lines()[0]["outputs"]["boxes"]["boxes"].as_array().unwrap().len()
    };
    let before = faces(&[]);
    assert!(before >= 2 && faces(&["--model", "half"]) == before, "{before}");
    let refused = place.run(["optimize", "yunet/320", "--out", "small"]).ends_with(2);
    assert!(refused.stderr.contains("--int8"), "{}", refused.stderr);
}

#[test]
fn wrong_usage_is_reported() {
    let Some(place) = place() else { return };
    for (flags, code, wanted) in [
        (&["--epochs", "0"][..], 12, "out of range"),
        (&["--epochs", "many"], 12, "epochs = many should be"),
        (&["--epoch", "1"], 2, "--epochs"),
        (&["--split", "nonsense"], 13, "nonsense"),
        (&["--format", "imagenet"], 11, "trains on BoundingBoxList"),
        (&["--val", "nowhere"], 13, "nowhere"),
        (&["--keep-empty"], 2, "--teacher"),
        (&["--teacher", "nonsense"], 13, "no learner \"nonsense\""),
    ] {
        let done = fit(&place, flags).ends_with(code);
        assert!(done.stderr.contains(wanted) && done.stdout.is_empty(), "{flags:?}: {done:#?}");
    }
    let unable = place.run(["fit", "ultra_light_face", "data"]).ends_with(18);
    assert!(unable.stderr.contains("UltraLightFaceLearner cannot fit"), "{}", unable.stderr);
    assert!(!place.path("runs").exists());
}
