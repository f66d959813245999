//! Damaged and malicious models cause an error with a precise message.

use crate::tiny::{Tiny, conv, noise};
use opendr_engine::ErrorKind;
use opendr_import::{ImportOptions, onnx_from_tfjs, tfjs_weight_files};
use serde_json::json;

#[track_caller]
fn refused(model: &Tiny, kind: ErrorKind, part: &str) {
    let error = model.import().err().map(|error| (error.kind(), error.to_string()));
    assert!(error.as_ref().is_some_and(|error| error.0 == kind && error.1.contains(part)), "{error:?}");
}

fn model() -> Tiny {
    let mut model = Tiny::with_input(&[1, 4, 4, 3]);
    model.floats("w", &[1, 1, 3, 2], &noise(6)).ints("shape", &[2], &[1, -1]);
    model.node("y", "Conv2D", &["x", "w"], conv(1, "SAME"));
    model.node("flat", "Reshape", &["y", "shape"], json!({})).output("flat");
    model
}

#[test]
fn cycles() {
    let mut model = Tiny::default();
    model.node("a", "Relu", &["b"], json!({})).node("b", "Relu", &["a"], json!({})).output("a");
    refused(&model, ErrorKind::Format, "form a cycle");
    let mut model = Tiny::default();
    model.node("a", "Relu", &["a"], json!({})).output("a");
    refused(&model, ErrorKind::Format, "form a cycle");
}

#[test]
fn missing_nodes_weights_and_outputs() {
    let mut missing = model();
    missing.node("z", "Relu", &["nowhere"], json!({})).output("z");
    refused(&missing, ErrorKind::Format, "tensor \"nowhere\" is needed, but no node produces it");
    let mut missing = model();
    missing.node("z", "Relu", &["x:7"], json!({})).output("z");
    refused(&missing, ErrorKind::Format, "node \"x\" (Placeholder) has no output 7");
    let mut missing = model();
    missing.weights.clear();
    refused(&missing, ErrorKind::Format, "the manifest has no such weight");
    let mut missing = model();
    missing.bytes.truncate(20);
    refused(&missing, ErrorKind::Format, "download the file again");
    let mut missing = model();
    missing.node("z", "Conv2D", &["x"], conv(1, "SAME")).output("z");
    refused(&missing, ErrorKind::Format, "input 1 is needed");
    let mut twice = model();
    twice.node("y", "Relu", &["x"], json!({}));
    refused(&twice, ErrorKind::Format, "two nodes have the name \"y\"");
}

#[test]
fn unknown_operators_are_named_with_their_node() {
    let mut model = model();
    model.node("z", "FancyNewOp", &["y"], json!({})).output("z");
    refused(&model, ErrorKind::Unsupported, "importing node \"z\" (FancyNewOp)");
}

#[test]
fn depth_costs_no_recursion() {
    let mut model = Tiny::with_input(&[1, 2]);
    for i in 0..50_000 {
        let input = if i == 0 { "x".to_owned() } else { format!("n{}", i - 1) };
        model.node(&format!("n{i}"), "Identity", &[&input], json!({}));
    }
    model.output("n49999");
    model.run(&[1, 2], &[1.0, 2.0])[0].assert_near(&[1, 2], &[1.0, 2.0]);
}

#[test]
fn small_files_cannot_ask_for_much() {
    // A million nodes.
    let mut many = Tiny::with_input(&[1 << 40, 1]);
    many.node("z", "Unpack", &["x"], json!({"num": {"i": "1000000"}})).output("z");
    refused(&many, ErrorKind::Unsupported, "unpacking");
    // A constant of 2^60 elements stays a node of the graph.
    let mut large = Tiny::default();
    large.ints("dims", &[2], &[1 << 30, 1 << 30]).ints("one", &[], &[1]);
    large.node("z", "Fill", &["dims", "one"], json!({})).output("z");
    assert!(large.import().unwrap().len() < 1000);
    // Many constants of 2^23 elements are no longer folded.
    let mut repeated = Tiny::default();
    repeated.ints("dims", &[2], &[1 << 13, 1 << 10]).floats("one", &[], &[1.0]);
    repeated.node("z0", "Fill", &["dims", "one"], json!({}));
    (1..200).for_each(|i| {
        repeated.node(&format!("z{i}"), "Neg", &[&format!("z{}", i - 1)], json!({}));
    });
    repeated.output("z199");
    repeated.import().unwrap();
    // Dimensions whose product overflows.
    let mut overflow = Tiny::with_input(&[i64::MAX, i64::MAX, i64::MAX, 3]);
    overflow.ints("shape", &[2], &[7, -1]).node("z", "Reshape", &["x", "shape"], json!({})).output("z");
    let _ = overflow.import();
}

#[test]
fn weight_files_stay_in_their_folder() {
    for path in ["../x.bin", "/etc/passwd", "a/../../x", "C:\\x", "a\\..\\x", "", "a//b", "https://host/x"] {
        let json =
            json!({"modelTopology": {}, "weightsManifest": [{"paths": [path], "weights": []}]}).to_string();
        let error = tfjs_weight_files(json.as_bytes()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Integrity, "{path}");
    }
    let json = json!({"modelTopology": {}, "weightsManifest": [{"paths": ["a/b.bin", "c"], "weights": []}]});
    assert_eq!(tfjs_weight_files(json.to_string().as_bytes()).unwrap(), ["a/b.bin", "c"]);
}

#[test]
fn other_formats_are_rejected_with_their_kind() {
    let import = |json: &str| onnx_from_tfjs(json.as_bytes(), &[], &ImportOptions::default()).unwrap_err();
    assert_eq!(import("not json").kind(), ErrorKind::Format);
    assert_eq!(import("{}").kind(), ErrorKind::Format);
    let layers = r#"{"format": "layers-model", "modelTopology": {}, "weightsManifest": []}"#;
    assert_eq!(import(layers).kind(), ErrorKind::Unsupported);
    assert_eq!(import(&"[".repeat(100_000)).kind(), ErrorKind::Format);
}

/// Every number of a model replaced by awkward ones, every byte of the file damaged: no panic.
#[test]
fn damage_never_panics() {
    let mut model = model();
    model.ints("pads", &[4, 2], &[0, 0, 1, 1, 1, 1, 0, 0]).ints("size", &[2], &[8, 8]).ints(
        "begin",
        &[2],
        &[0, 1],
    );
    model.ints("end", &[2], &[1, 9]).ints("step", &[2], &[1, 2]).ints("axis", &[], &[1]);
    model.node("padded", "Pad", &["y", "pads"], json!({}));
    model.node("large", "ResizeBilinear", &["padded", "size"], json!({"half_pixel_centers": {"b": true}}));
    let mut pool = conv(2, "SAME");
    pool["ksize"] = json!({"list": {"i": ["1", "2", "2", "1"]}});
    model.node("pooled", "MaxPool", &["large"], pool).output("pooled");
    let masks = json!({"begin_mask": {"i": "1"}, "end_mask": {"i": "1"}, "new_axis_mask": {"i": "0"}});
    model.node("cut", "StridedSlice", &["flat", "begin", "end", "step"], masks);
    model.node("parts", "Split", &["axis", "flat"], json!({"num_split": {"i": "2"}}));
    model.node("joined", "ConcatV2", &["cut", "parts:1", "axis"], json!({})).output("joined");
    model.node("shape2", "Shape", &["large"], json!({}));
    model.node("tiled", "Tile", &["shape2", "axis1"], json!({})).ints("axis1", &[1], &[3]).output("tiled");
    model.node("back", "Conv2DBackpropInput", &["back_shape", "back_w", "y"], conv(2, "SAME")).output("back");
    model.ints("back_shape", &[4], &[1, 8, 8, 1]).floats("back_w", &[3, 3, 1, 2], &noise(18));
    model.import().unwrap();

    let import = |json: &[u8], bytes: &[u8]| {
        let _ = onnx_from_tfjs(json, &[bytes], &ImportOptions::default());
    };
    let (json, bytes) = (model.json(), model.bytes.clone());
    for word in 0..bytes.len() / 4 {
        for value in [0, 1, -1, 3, i32::MAX, i32::MIN] {
            let mut damaged = bytes.clone();
            damaged[word * 4..word * 4 + 4].copy_from_slice(&value.to_le_bytes());
            import(&json, &damaged);
        }
    }
    for position in 0..json.len() {
        for replacement in *b"09-\"]" {
            let mut damaged = json.clone();
            damaged[position] = replacement;
            import(&damaged, &bytes);
        }
    }
}
