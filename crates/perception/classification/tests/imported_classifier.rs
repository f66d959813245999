//! A classifier that another package exported, beside the package's own scores.
//!
//! `tests/extended/exported_network_fixtures.py` writes the fixture: a small network with random weights.

#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use opendr_classification::image_classification::{
    ClassScoreFormat, ImportedClassifier, ImportedClassifierParams,
};
use opendr_engine::data::Image;
use opendr_engine::learner::Handle;
use opendr_engine::{Device, ErrorKind};
use opendr_onnx::{Builder, ElementType, Operator, bytes_from_model, model_from_graph};
use opendr_perception_common::exported_network::{
    InputColour, InputLevels, InputParams, InputResize, NetworkKind,
};
use opendr_perception_testing::fixture_image::fixture_image;
use opendr_perception_testing::learner_checks::check_trained_learner;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/imported").join(name)
}

fn load(
    path: PathBuf,
    params: ImportedClassifierParams,
) -> opendr_engine::Result<Handle<ImportedClassifier>> {
    let mut classifier = Handle::<ImportedClassifier>::new(params, Device::Cpu)?;
    classifier.load(path)?;
    Ok(classifier)
}

#[test]
fn scores_are_those_of_the_package() {
    let text = std::fs::read(fixture("yolo_classify.json")).unwrap();
    let expected: serde_json::Value = serde_json::from_slice(&text).unwrap();
    let mut classifier = load(fixture("yolo_classify.zip"), ImportedClassifierParams::default()).unwrap();
    let ImportedClassifierParams { scores, crop, .. } = classifier.params();
    assert_eq!((*scores, *crop), (ClassScoreFormat::Probabilities, Some(1.0)));
    let found = classifier.infer(&fixture_image(64, 64)).unwrap();
    let wanted: Vec<f32> =
        expected["scores"].as_array().unwrap().iter().map(|score| score.as_f64().unwrap() as f32).collect();
    assert_eq!(found.probabilities.len(), wanted.len());
    assert!(found.probabilities.iter().zip(&wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-3));
    assert_eq!(found.description.as_deref(), Some("ball"));
}

/// Writes a network whose logits are the means of the channels.
fn means(name: &str) -> PathBuf {
    let mut graph = Builder::default();
    let image = graph.input("image", ElementType::Float, [1, 3, 8, 8].map(Some).to_vec(), &[]);
    let mean = Operator::new("ReduceMean").ints("axes", 2..4).int("keepdims", 0);
    let scores = [1, 3].map(Some).to_vec();
    let scores = graph.add("means", mean, &[&image], ElementType::Float, scores).unwrap();
    graph.output("scores", &scores, "", &[]).unwrap();
    let folder = std::env::temp_dir().join(format!("opendr-classifier-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("{name}.onnx"));
    std::fs::write(&path, bytes_from_model(&model_from_graph(graph.finish("means")))).unwrap();
    path
}

#[test]
fn a_network_without_metadata_takes_parameters() {
    let path = means("plain");
    assert!(NetworkKind::Classifier.recognises(&std::fs::read(&path).unwrap()));
    let error = load(path.clone(), ImportedClassifierParams::default()).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::Unsupported, "{error:#}");
    assert!(format!("{error:#}").contains("set resize, colour, levels, and crop"), "{error:#}");
    let input = InputParams {
        resize: InputResize::Stretch,
        colour: InputColour::Rgb,
        levels: InputLevels::Unit,
        ..InputParams::default()
    };
    let params = ImportedClassifierParams { input, ..ImportedClassifierParams::default() };
    let mut classifier = load(path, params).unwrap();
    assert_eq!(classifier.params().scores, ClassScoreFormat::Logits);
    let image = Image::from_rgb8([255, 0, 51].repeat(64), 8, 8).unwrap();
    let found = classifier.infer(&image).unwrap();
    let exponents = [1.0_f32, 0.0, 0.2].map(f32::exp);
    let sum: f32 = exponents.iter().sum();
    let wanted = exponents.map(|exponent| exponent / sum);
    assert!(found.probabilities.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-4));
}

#[test]
fn it_is_a_learner() {
    let scratch = std::env::temp_dir().join(format!("opendr-imported-classifier-{}", std::process::id()));
    let calls = [[64, 64], [80, 50], [31, 90]];
    let calls = calls.map(|[width, height]| vec![fixture_image(width, height).into()]);
    check_trained_learner::<ImportedClassifier>(&fixture("yolo_classify.zip"), &scratch, calls.into());
    std::fs::remove_dir_all(&scratch).ok();
}
