//! Segmenters that other packages exported, beside the packages' own predictions.
//!
//! `tests/extended/exported_network_fixtures.py` writes the fixtures: small networks with random weights.

#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use opendr_engine::data::Image;
use opendr_engine::learner::Handle;
use opendr_engine::target::HeatmapValues;
use opendr_engine::{Device, ErrorKind, Result};
use opendr_onnx::{Builder, ElementType, Operator, bytes_from_model, model_from_graph};
use opendr_perception_common::exported_network::{
    InputColour, InputLevels, InputParams, InputResize, NetworkKind,
};
use opendr_perception_testing::fixture_image::fixture_image;
use opendr_perception_testing::learner_checks::check_trained_learner;
use opendr_segmentation::semantic_segmentation::{ImportedSegmenter, ImportedSegmenterParams, MapFormat};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/imported").join(name)
}

fn load(path: PathBuf, params: ImportedSegmenterParams) -> Result<Handle<ImportedSegmenter>> {
    let mut segmenter = Handle::<ImportedSegmenter>::new(params, Device::Cpu)?;
    segmenter.load(path)?;
    Ok(segmenter)
}

fn labels(segmenter: &mut Handle<ImportedSegmenter>, image: &Image) -> (Vec<u32>, Vec<usize>) {
    let map = segmenter.infer(image).unwrap();
    let HeatmapValues::Labels(labels) = map.values() else { return (Vec::new(), Vec::new()) };
    (labels.to_vec(), map.shape().to_vec())
}

#[test]
fn classes_are_those_of_the_packages() {
    for name in ["torchvision_fcn", "segformer"] {
        let text = std::fs::read(fixture(&format!("{name}.json"))).unwrap();
        let expected: serde_json::Value = serde_json::from_slice(&text).unwrap();
        let rows = expected["labels"].as_array().unwrap().iter().map(|row| row.as_str().unwrap());
        let wanted: Vec<u32> = rows.flat_map(str::bytes).map(|digit| u32::from(digit - b'0')).collect();
        let mut segmenter =
            load(fixture(&format!("{name}.zip")), ImportedSegmenterParams::default()).unwrap();
        let (found, shape) = labels(&mut segmenter, &fixture_image(64, 64));
        assert_eq!(shape, [64, 64]);
        let same = found.iter().zip(&wanted).filter(|(found, wanted)| found == wanted).count();
        assert!(same * 1000 >= 999 * wanted.len(), "{name}: {same} of {} pixels", wanted.len());
    }
}

/// Writes a network that takes an image of 8 x 8 pixels and returns its channels, each pixel's largest the class.
fn channels(name: &str, last: bool, as_labels: bool) -> PathBuf {
    let mut graph = Builder::default();
    let shape = if last { [1, 8, 8, 3] } else { [1, 3, 8, 8] }.map(Some).to_vec();
    let image = graph.input("image", ElementType::Float, shape.clone(), &[]);
    if as_labels {
        let argmax = Operator::new("ArgMax").int("axis", 1).int("keepdims", 0);
        let labels = [1, 8, 8].map(Some).to_vec();
        let classes = graph.add("classes", argmax, &[&image], ElementType::Int, labels).unwrap();
        graph.output("labels", &classes, "", &[]).unwrap();
    } else {
        let softmax = Operator::new("Softmax").int("axis", if last { 3 } else { 1 });
        let scores = graph.add("softmax", softmax, &[&image], ElementType::Float, shape).unwrap();
        graph.output("scores", &scores, "", &[]).unwrap();
    }
    let folder = std::env::temp_dir().join(format!("opendr-segmenter-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("{name}.onnx"));
    std::fs::write(&path, bytes_from_model(&model_from_graph(graph.finish(name)))).unwrap();
    path
}

fn stretched() -> ImportedSegmenterParams {
    let input = InputParams {
        resize: InputResize::Stretch,
        colour: InputColour::Rgb,
        levels: InputLevels::Unit,
        ..InputParams::default()
    };
    ImportedSegmenterParams { input, ..ImportedSegmenterParams::default() }
}

#[test]
fn maps_of_every_format_are_the_same() {
    let paths = [
        (channels("first", false, false), MapFormat::ChannelsFirst),
        (channels("last", true, false), MapFormat::ChannelsLast),
        (channels("labels", false, true), MapFormat::Labels),
    ];
    let mut maps = Vec::new();
    for (path, format) in paths {
        assert!(NetworkKind::Segmenter.recognises(&std::fs::read(&path).unwrap()), "{format:?}");
        let mut segmenter = load(path, stretched()).unwrap();
        assert_eq!(segmenter.params().map, format);
        maps.push(labels(&mut segmenter, &fixture_image(8, 8)));
    }
    assert_eq!((&maps[0], &maps[1]), (&maps[1], &maps[2]));
    assert!(maps[0].0.iter().any(|label| *label > 0));
}

#[test]
fn maps_have_the_size_of_the_image_or_of_the_network() {
    let path = channels("sizes", false, false);
    let mut segmenter = load(path.clone(), stretched()).unwrap();
    assert_eq!(labels(&mut segmenter, &fixture_image(21, 13)).1, [13, 21]);
    let mut coarse = load(path, ImportedSegmenterParams { full_size: false, ..stretched() }).unwrap();
    assert_eq!(labels(&mut coarse, &fixture_image(21, 13)).1, [8, 8]);
}

#[test]
fn what_is_not_stated_is_an_error_that_names_the_parameter() {
    let error = load(channels("silent", false, false), ImportedSegmenterParams::default()).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    assert!(format!("{error:#}").contains("set resize, colour, levels"), "{error:#}");
    let params = ImportedSegmenterParams { map_output: Some("masks".into()), ..stretched() };
    let error = load(channels("named", false, false), params).err().unwrap();
    assert!(format!("{error:#}").contains("no output \"masks\""), "{error:#}");
    let params = ImportedSegmenterParams { map: MapFormat::Labels, ..stretched() };
    let mut wrong = load(channels("format", false, false), params).unwrap();
    let error = wrong.infer(&fixture_image(8, 8)).unwrap_err();
    assert!(format!("{error:#}").contains("set map"), "{error:#}");
}

#[test]
fn it_is_a_learner() {
    let scratch = std::env::temp_dir().join(format!("opendr-imported-segmenter-{}", std::process::id()));
    let calls = [[64, 64], [80, 50], [31, 90]];
    let calls = calls.map(|[width, height]| vec![fixture_image(width, height).into()]);
    check_trained_learner::<ImportedSegmenter>(&fixture("segformer.zip"), &scratch, calls.into());
    std::fs::remove_dir_all(&scratch).ok();
}
