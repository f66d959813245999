//! Networks like CLIP that transformers and `open_clip` made, beside their own probabilities.
//!
//! `tests/extended/exported_clip_fixtures.py` writes the fixtures: small networks with random weights.

#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use opendr_classification::image_classification::{
    ImportedZeroShotClassifier, ImportedZeroShotClassifierParams,
};
use opendr_engine::learner::Handle;
use opendr_engine::model::{Manifest, Model, ModelWriter};
use opendr_engine::params::ParamValue;
use opendr_engine::{Device, ErrorKind, Result};
use opendr_onnx::{bytes_from_model, model_from_bytes};
use opendr_perception_common::exported_network::{InputLevels, InputParams, InputResize, NetworkKind};
use opendr_perception_testing::fixture_image::fixture_image;
use opendr_perception_testing::learner_checks::check_trained_learner;

type Params = ImportedZeroShotClassifierParams;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/imported").join(name)
}

fn load(path: impl AsRef<Path>, params: Params) -> Result<Handle<ImportedZeroShotClassifier>> {
    let mut classifier = Handle::<ImportedZeroShotClassifier>::new(params, Device::Cpu)?;
    classifier.load(path)?;
    Ok(classifier)
}

fn labelled(labels: &str) -> Params {
    Params { labels: labels.into(), ..Params::default() }
}

/// Writes files of the fixtures as a container in a folder of its own.
fn container(name: &str, files: &[(&str, Vec<u8>)]) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("opendr-zero-shot-{}-{name}", std::process::id()));
    let mut writer = ModelWriter::new(&folder, Manifest::new("zero_shot_classifier", "")).unwrap();
    files.iter().for_each(|(name, bytes)| writer.add(name, bytes).unwrap());
    writer.finish().unwrap();
    folder
}

fn file(fixture_name: &str, name: &str) -> Vec<u8> {
    Model::open(fixture(fixture_name)).unwrap().file(name).unwrap()
}

#[test]
fn probabilities_are_those_of_the_packages() {
    for name in ["clip", "clip_parts", "open_clip"] {
        let text = std::fs::read(fixture(&format!("{name}.json"))).unwrap();
        let expected: serde_json::Value = serde_json::from_slice(&text).unwrap();
        let scale = expected["logit_scale"].as_f64().unwrap() as f32;
        // Two networks do not state it.
        let given = (name == "clip_parts").then_some(scale);
        let params = Params { logit_scale: given, ..labelled(expected["labels"].as_str().unwrap()) };
        let mut classifier = load(fixture(&format!("{name}.zip")), params).unwrap();
        let Params { logit_scale, context_length, crop, input, .. } = classifier.params();
        assert_eq!((*context_length, *crop), (Some(77), Some(1.0)));
        assert!((logit_scale.unwrap() - scale).abs() < 1e-4);
        assert_eq!((input.resize, input.levels), (InputResize::Stretch, InputLevels::Clip));
        for case in expected["images"].as_array().unwrap() {
            let [width, height] = [0, 1].map(|at| case["size"][at].as_u64().unwrap() as usize);
            let found = classifier.infer(&fixture_image(width, height)).unwrap();
            let wanted: Vec<f32> = serde_json::from_value(case["probabilities"].clone()).unwrap();
            let error =
                found.probabilities.iter().zip(&wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            println!("{name} {width}x{height}: {error}");
            assert_eq!(found.probabilities.len(), wanted.len());
            assert!(error < 1e-3, "{name} {width}x{height}: {:?} {wanted:?}", found.probabilities);
            let best = wanted.iter().copied().fold(0.0, f32::max);
            let label = expected["labels"].as_str().unwrap().split(';').nth(found.class as usize);
            assert_eq!(found.description.as_deref(), label);
            assert!((found.confidence.unwrap() - best).abs() < 1e-3);
        }
    }
}

#[test]
fn texts_change_while_it_runs() {
    let image = fixture_image(32, 32);
    let mut classifier = load(fixture("clip.zip"), Params::default()).unwrap();
    assert_eq!(classifier.classes().len(), 4);
    let first = classifier.infer(&image).unwrap();
    let mut set = |name: &str, value: ParamValue| {
        classifier.set(name, value).unwrap();
        classifier.infer(&image)
    };
    let more = set("labels", "cat; red traffic cone; dog's bowl; empty café; window".into()).unwrap();
    assert_eq!(more.probabilities.len(), 5);
    // Four of the classes are the same; so are their odds.
    let odds = |probabilities: &[f32]| probabilities[1] / probabilities[2];
    assert!((odds(&first.probabilities) - odds(&more.probabilities)).abs() < 1e-4);
    let other = set("template", "{}".into()).unwrap();
    assert!((odds(&other.probabilities) - odds(&more.probabilities)).abs() > 1e-3);
    let flat = set("logit_scale", 0.001.into()).unwrap();
    assert!(flat.probabilities.iter().all(|probability| (probability - 0.2).abs() < 1e-3));
    let error = set("template", "a photo".into()).unwrap_err();
    assert!(error.to_string().contains("{}"), "{error:#}");
    set("template", "a photo of a {}".into()).unwrap();
    set("logit_scale", 20.0.into()).unwrap();
    let again = set("labels", "".into()).unwrap();
    assert_eq!(again.class, first.class);
    assert!((odds(&again.probabilities) - odds(&first.probabilities)).abs() < 1e-4);
}

#[test]
fn labels_are_needed() {
    let mut classifier = load(fixture("clip_parts.zip"), Params::default()).unwrap();
    let error = classifier.infer(&fixture_image(32, 32)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidParam);
    assert!(format!("{error:#}").contains("set labels"), "{error:#}");
    assert_eq!(classifier.params().logit_scale, Some(100.0));
    classifier.set("labels", "cat, dog".into()).unwrap();
    assert_eq!(classifier.infer(&fixture_image(32, 32)).unwrap().probabilities.len(), 2);
}

#[test]
fn what_is_missing_is_named() {
    let refused = |name: &str, files: &[(&str, Vec<u8>)], params: Params, text: &str| {
        let folder = container(name, files);
        let error = load(&folder, params).err().unwrap();
        assert!(format!("{error:#}").contains(text), "{error:#}");
        std::fs::remove_dir_all(folder).ok();
    };
    let both = file("clip.zip", "model.onnx");
    let tokenizer = file("clip.zip", "tokenizer.json");
    let [image, text] = ["model.onnx", "text.onnx"].map(|name| file("clip_parts.zip", name));
    refused(
        "tokenizer",
        &[("model.onnx", both.clone())],
        Params::default(),
        "--part tokenizer=tokenizer.json",
    );
    let alone = [("model.onnx", image.clone()), ("tokenizer.json", tokenizer.clone())];
    refused("text", &alone, Params::default(), "--part text=");
    let swapped =
        [("model.onnx", text.clone()), ("text.onnx", image.clone()), ("tokenizer.json", tokenizer.clone())];
    refused("swapped", &swapped, Params::default(), "set image_output");
    let twice =
        [("model.onnx", both.clone()), ("text.onnx", both.clone()), ("tokenizer.json", tokenizer.clone())];
    let folder = container("twice", &twice);
    load(&folder, labelled("cat, dog")).unwrap();
    std::fs::remove_dir_all(folder).ok();
    let unigram = br#"{"model": {"type": "Unigram", "vocab": [["a", 0.0]]}}"#.to_vec();
    refused(
        "unigram",
        &[("model.onnx", both.clone()), ("tokenizer.json", unigram)],
        Params::default(),
        "SigLIP",
    );
    let whole = [("model.onnx", both.clone()), ("tokenizer.json", tokenizer.clone())];
    refused(
        "output",
        &whole,
        Params { image_output: Some("scores".into()), ..Params::default() },
        "named scores",
    );
    let size =
        |size| Params { input: InputParams { size: Some(size), ..Default::default() }, ..Params::default() };
    refused("size", &whole, size(64), "64 x 64 pixels; set size");
    let length = Params { context_length: Some(5), ..Params::default() };
    let fixed = [("model.onnx", file("open_clip.zip", "model.onnx")), ("tokenizer.json", tokenizer.clone())];
    refused("length", &fixed, length, "77 tokens");
    let long = Params { context_length: Some(78), ..labelled("cat, dog") };
    refused("long", &whole, long, "a photo of a cat");
    // Without the names of the weights, nothing states the input.
    let mut model = model_from_bytes(&both).unwrap();
    let graph = model.graph.as_mut().unwrap();
    let hidden = |name: &mut String| *name = name.replace("class_embedding", "token");
    graph.initializer.iter_mut().for_each(|tensor| hidden(&mut tensor.name));
    graph.node.iter_mut().flat_map(|node| &mut node.input).for_each(hidden);
    let nameless = [("model.onnx", bytes_from_model(&model)), ("tokenizer.json", tokenizer)];
    refused("nameless", &nameless, Params::default(), "set resize, colour, levels");
    assert!(NetworkKind::ZeroShotClassifier.recognises(&both));
    assert!(NetworkKind::ZeroShotClassifier.recognises(&image));
    assert!(!NetworkKind::ZeroShotClassifier.recognises(&text));
}

#[test]
fn similarities_with_a_bias_are_refused() {
    let mut model = model_from_bytes(&file("clip.zip", "model.onnx")).unwrap();
    let graph = model.graph.as_mut().unwrap();
    // SigLIP adds its bias where CLIP has a transposition alone; here the factor is added too.
    let scale = graph.node.iter().find(|node| node.op_type == "Exp").unwrap().output[0].clone();
    let last = graph.node.iter_mut().find(|node| node.output[0] == "logits_per_image").unwrap();
    last.op_type = "Add".into();
    last.attribute.clear();
    last.input.push(scale);
    let files =
        [("model.onnx", bytes_from_model(&model)), ("tokenizer.json", file("clip.zip", "tokenizer.json"))];
    let folder = container("bias", &files);
    let error = load(&folder, Params::default()).err().unwrap();
    assert!(format!("{error:#}").contains("SigLIP"), "{error:#}");
    std::fs::remove_dir_all(folder).ok();
}

#[test]
fn it_is_a_learner() {
    let scratch = std::env::temp_dir().join(format!("opendr-zero-shot-learner-{}", std::process::id()));
    let calls = [[64, 64], [80, 50], [31, 90]];
    let calls = calls.map(|[width, height]| vec![fixture_image(width, height).into()]);
    check_trained_learner::<ImportedZeroShotClassifier>(&fixture("clip.zip"), &scratch, calls.into());
    std::fs::remove_dir_all(&scratch).ok();
}
