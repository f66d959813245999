//! Promptable segmenters that other packages exported, beside the packages' own predictions.
//!
//! `tests/extended/promptable_fixtures.py` writes the fixtures: small networks with random weights.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::{Path, PathBuf};

use opendr_engine::data::Image;
use opendr_engine::learner::Handle;
use opendr_engine::model::{Manifest, Model, ModelWriter};
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes, Name, Rle, Segmentation};
use opendr_engine::{Device, ErrorKind, Result, Value};
use opendr_perception_common::exported_network::{InputLevels, NetworkKind};
use opendr_perception_testing::fixture_image::fixture_image;
use opendr_perception_testing::learner_checks::check_trained_learner;
use opendr_segmentation::instance_segmentation::{
    ImportedPromptableSegmenter, ImportedPromptableSegmenterParams, MaskSelection, PromptableInputs,
};

/// Largest difference of a predicted IoU.
const TOLERANCE: f32 = 1e-3;
/// Smallest share of the pixels that are equal.
const SAME: f64 = 0.999;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/imported").join(name)
}

fn load(
    path: &Path,
    params: ImportedPromptableSegmenterParams,
) -> Result<Handle<ImportedPromptableSegmenter>> {
    let mut segmenter = Handle::<ImportedPromptableSegmenter>::new(params, Device::Cpu)?;
    segmenter.load(path)?;
    Ok(segmenter)
}

fn with_points(points: &str) -> ImportedPromptableSegmenterParams {
    ImportedPromptableSegmenterParams { points: points.into(), ..Default::default() }
}

fn open(name: &str, points: &str) -> Handle<ImportedPromptableSegmenter> {
    load(&fixture(&format!("{name}.zip")), with_points(points)).unwrap()
}

fn infer(
    segmenter: &mut Handle<ImportedPromptableSegmenter>,
    image: &Image,
    detections: Option<&BoundingBoxList>,
) -> Result<BoundingBoxList> {
    segmenter.infer(PromptableInputs { image, detections })
}

fn mask(found: &BoundingBox) -> Vec<bool> {
    let Segmentation::Rle(rle) = &found.segment.as_ref().unwrap().segmentation else { panic!("{found:?}") };
    rle.mask().unwrap()
}

fn boxes(corners: &[[f32; 4]]) -> BoundingBoxList {
    let of = |corners: &[f32; 4]| BoundingBox::from_corners("ball", *corners, 0.9);
    corners.iter().map(of).collect::<Vec<_>>().into()
}

/// Compares masks and predicted IoUs of a fixture with those of its package; returns the number of prompts.
fn compare(name: &str) -> usize {
    let text = std::fs::read(fixture(&format!("{name}.json"))).unwrap();
    let expected: serde_json::Value = serde_json::from_slice(&text).unwrap();
    let [width, height] = [0, 1].map(|side| expected["image"][side].as_u64().unwrap() as usize);
    let image = fixture_image(width, height);
    let prompts = expected["prompts"].as_array().unwrap();
    for prompt in prompts {
        let corners = prompt["box"]
            .as_array()
            .map(|corners| boxes(&[std::array::from_fn(|at| corners[at].as_f64().unwrap() as f32)]));
        let mut segmenter = open(name, prompt["points"].as_str().unwrap_or_default());
        let found = infer(&mut segmenter, &image, corners.as_ref()).unwrap();
        let [found] = &found.boxes[..] else { panic!("{name}: {found:?}") };
        let iou = prompt["iou"].as_f64().unwrap() as f32;
        assert!((found.confidence - iou).abs() <= TOLERANCE, "{name}: {} instead of {iou}", found.confidence);
        let counts = prompt["mask"].as_array().unwrap().iter().map(|run| run.as_u64().unwrap() as u32);
        let wanted = Rle::new(height as u32, width as u32, counts.collect()).unwrap().mask().unwrap();
        let same = mask(found).iter().zip(&wanted).filter(|(found, wanted)| found == wanted).count();
        println!("{name}: {same} of {} pixels", wanted.len());
        assert!(same as f64 >= SAME * wanted.len() as f64, "{name}: {same} of {} pixels", wanted.len());
        match corners {
            Some(given) => assert_eq!(found.corners(), given.boxes[0].corners()),
            None => {
                let set = (0..).zip(mask(found)).filter(|(_, is_set)| *is_set).map(|(at, _)| at);
                let columns: Vec<usize> = set.map(|at: usize| at % width).collect();
                assert_eq!(found.left, *columns.iter().min().unwrap() as f32);
                assert_eq!(found.corners()[2], *columns.iter().max().unwrap() as f32 + 1.0);
            }
        }
    }
    prompts.len()
}

#[test]
fn segment_anything() {
    assert_eq!(compare("segment_anything"), 4);
    assert_eq!(compare("segment_anything_single"), 2);
}

#[test]
fn edge_sam() {
    assert_eq!(compare("edge_sam"), 4);
}

#[test]
fn transformers() {
    assert_eq!(compare("sam_transformers"), 2);
}

#[test]
fn each_box_keeps_its_class_and_gets_its_mask() {
    let image = fixture_image(90, 60);
    let all = [[12.0, 8.0, 61.5, 47.0], [40.0, 20.0, 88.0, 59.0]];
    let mut given = boxes(&all);
    given.classes = Classes::from_iter(["car", "door"]);
    given.boxes[1].name = Name::Index(1);
    given.boxes.push(BoundingBox { width: f32::NAN, ..given.boxes[0].clone() });
    let mut segmenter = open("segment_anything", "");
    let found = infer(&mut segmenter, &image, Some(&given)).unwrap();
    assert_eq!(found.classes, given.classes);
    let names: Vec<_> = found.boxes.iter().map(|found| found.name.clone()).collect();
    assert_eq!(names, [Name::from("ball"), Name::Index(1)]);
    for (found, corners) in found.boxes.iter().zip(all) {
        let alone = infer(&mut segmenter, &image, Some(&boxes(&[corners]))).unwrap();
        assert_eq!((mask(found), found.confidence), (mask(&alone.boxes[0]), alone.boxes[0].confidence));
    }
    // Points are an object of their own.
    let mut both = open("segment_anything", "31,22.5");
    let found = infer(&mut both, &image, Some(&given)).unwrap().boxes;
    assert_eq!((found.len(), &found[0].name), (3, &Name::Index(0)));
    assert_eq!(infer(&mut both, &image, None).unwrap().boxes, found[..1]);
    let none = infer(&mut segmenter, &image, Some(&BoundingBoxList::default())).unwrap();
    assert!(none.boxes.is_empty());
}

#[test]
fn thresholds_and_the_choice_of_masks_are_parameters() {
    let image = fixture_image(90, 60);
    let found = |params: ImportedPromptableSegmenterParams| {
        let mut segmenter = load(&fixture("segment_anything.zip"), params).unwrap();
        infer(&mut segmenter, &image, None).unwrap().boxes
    };
    let auto = found(with_points("31,22.5"));
    let best =
        found(ImportedPromptableSegmenterParams { multimask: MaskSelection::Best, ..with_points("31,22.5") });
    let single = found(ImportedPromptableSegmenterParams {
        multimask: MaskSelection::Single,
        ..with_points("31,22.5")
    });
    assert_eq!(auto, best);
    assert_ne!(auto, single);
    let strict = ImportedPromptableSegmenterParams { quality_threshold: 0.99, ..with_points("31,22.5") };
    assert!(found(strict).is_empty());
    let lower = ImportedPromptableSegmenterParams { mask_threshold: -2.0, ..with_points("31,22.5") };
    let area = |boxes: &[BoundingBox]| boxes[0].segment.as_ref().unwrap().area;
    assert!(area(&found(lower)) > area(&auto));
    let nothing = ImportedPromptableSegmenterParams { mask_threshold: 50.0, ..with_points("31,22.5") };
    assert!(found(nothing).is_empty());
}

#[test]
fn prompts_that_are_missing_or_not_understood_are_errors() {
    let image = fixture_image(90, 60);
    let error = infer(&mut open("segment_anything", ""), &image, None).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidInput);
    assert!(error.to_string().contains("set points"), "{error}");
    let error = load(&fixture("segment_anything.zip"), with_points("1;2")).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::InvalidParam);
    let given = boxes(&[[1.0, 2.0, 30.0, 40.0]]);
    let error = infer(&mut open("sam_transformers", "1,2"), &image, Some(&given)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    let single = ImportedPromptableSegmenterParams { multimask: MaskSelection::Single, ..Default::default() };
    let error = load(&fixture("sam_transformers.zip"), single).err().unwrap();
    assert!(format!("{error:#}").contains("set multimask"), "{error:#}");
}

fn file(fixture_name: &str, name: &str) -> Vec<u8> {
    Model::open(fixture(&format!("{fixture_name}.zip"))).unwrap().file(name).unwrap()
}

#[test]
fn the_order_of_the_files_does_not_matter_and_others_are_refused() {
    let scratch = std::env::temp_dir().join(format!("opendr-promptable-{}", std::process::id()));
    let decoder = file("segment_anything", "decoder.onnx");
    let encoder = file("segment_anything", "model.onnx");
    for onnx in [&decoder, &encoder] {
        assert!(NetworkKind::PromptableSegmenter.recognises(onnx));
    }
    let written = |name: &str, files: &[(&str, &[u8])]| {
        let path = scratch.join(name);
        let mut writer = ModelWriter::new(&path, Manifest::new("promptable_segmenter", "")).unwrap();
        files.iter().for_each(|(name, bytes)| writer.add(name, bytes).unwrap());
        writer.finish().unwrap();
        path
    };
    let image = fixture_image(90, 60);
    let path = written("turned", &[("model.onnx", &decoder), ("encoder.onnx", &encoder)]);
    let turned = infer(&mut load(&path, with_points("31,22.5")).unwrap(), &image, None).unwrap();
    assert_eq!(turned.boxes, infer(&mut open("segment_anything", "31,22.5"), &image, None).unwrap().boxes);

    let refused = |path: &Path, text: &str| {
        let error = load(path, with_points("1,2")).err().unwrap();
        assert_eq!(error.kind(), ErrorKind::Unsupported, "{error:#}");
        assert!(format!("{error:#}").contains(text), "{error:#}");
    };
    let alone = written("decoder", &[("model.onnx", &decoder)]);
    refused(&alone, "encoder of images and the decoder of prompts; give both");
    refused(&written("encoder", &[("model.onnx", &encoder)]), "none of the 1 networks is the decoder");
    let twice = written("twice", &[("model.onnx", &decoder), ("other.onnx", &decoder)]);
    refused(&twice, "the encoder: no input of the network is an image");
    let foreign = file("segformer", "model.onnx");
    refused(&written("foreign", &[("model.onnx", &foreign), ("decoder.onnx", &decoder)]), "do not match");
    let other = file("sam_transformers", "prompt_encoder_mask_decoder.onnx");
    refused(&written("mixed", &[("model.onnx", &encoder), ("decoder.onnx", &other)]), "do not match");
    std::fs::remove_dir_all(&scratch).ok();
}

#[test]
fn levels_are_recognised_or_set() {
    let mut segmenter = open("segment_anything", "31,22.5");
    assert_eq!(segmenter.params().levels, InputLevels::ImageNet);
    let params = ImportedPromptableSegmenterParams { levels: InputLevels::Unit, ..with_points("31,22.5") };
    let mut unit = load(&fixture("segment_anything.zip"), params).unwrap();
    let image = fixture_image(90, 60);
    let [found, other] = [&mut segmenter, &mut unit].map(|one| infer(one, &image, None).unwrap());
    assert_ne!(found, other);
}

#[test]
fn it_is_a_learner() {
    let scratch = std::env::temp_dir().join(format!("opendr-promptable-learner-{}", std::process::id()));
    let calls = [[90, 60], [80, 80], [31, 90]].map(|[width, height]| {
        let corners = vec![[2.0, 3.0, 20.0, 25.0]; width / 30];
        vec![Value::from(fixture_image(width, height)), boxes(&corners).into()]
    });
    check_trained_learner::<ImportedPromptableSegmenter>(
        &fixture("segment_anything.zip"),
        &scratch,
        calls.into(),
    );
    std::fs::remove_dir_all(&scratch).ok();
}
