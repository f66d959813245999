//! Channels-last graphs become channels-first, with the same values.

use crate::tiny::{Tiny, conv, noise};
use opendr_import::{ImportOptions, onnx_from_tfjs};
use serde_json::{Value as Json, json};

/// A model whose input passes an identity convolution, so that it is stored channels-first.
fn stored_channels_first(height: i64, width: i64, channels: usize) -> Tiny {
    let mut model = Tiny::with_input(&[1, height, width, 3]);
    let mut identity = vec![0.0; 3 * channels];
    (0..channels).for_each(|channel| identity[channel % 3 * channels + channel] = 1.0);
    model.floats("w", &[1, 1, 3, channels], &identity);
    model.node("map", "Conv2D", &["x", "w"], conv(1, "SAME"));
    model
}

const NONE: fn() -> Json = || json!({});

#[test]
fn transpositions_of_a_channels_first_graph_vanish() {
    let mut model = Tiny::with_input(&[1, 3, 4, 5]);
    model.ints("to_last", &[4], &[0, 2, 3, 1]).ints("to_first", &[4], &[0, 3, 1, 2]);
    model.floats("w", &[1, 1, 3, 2], &noise(6)).floats("b", &[2], &[1.0, 2.0]);
    model.node("last", "Transpose", &["x", "to_last"], NONE());
    model.node("conv", "Conv2D", &["last", "w"], conv(1, "SAME"));
    model.node("sum", "Add", &["conv", "b"], NONE());
    model.node("y", "Transpose", &["sum", "to_first"], NONE()).output("y");
    assert_eq!(model.operators(), ["Conv"]);
}

#[test]
fn flattening_puts_channels_last() {
    let mut model = stored_channels_first(2, 2, 3);
    model.ints("shape", &[2], &[1, -1]);
    model.node("y", "Reshape", &["map", "shape"], NONE()).output("y");
    let x = noise(12);
    model.run(&[1, 2, 2, 3], &x)[0].assert_near(&[1, 12], &x);
}

#[test]
fn merging_pixels_moves_nothing() {
    let mut model = stored_channels_first(2, 3, 3);
    model.ints("shape", &[3], &[1, 6, 3]).ints("axis", &[], &[1]);
    model.node("pixels", "Reshape", &["map", "shape"], NONE());
    model.node("y", "ArgMax", &["pixels", "axis"], NONE()).output("y");
    let mut x = vec![0.0; 18];
    (x[4 * 3], x[3 + 1], x[5 * 3 + 2]) = (1.0, 1.0, 1.0);
    model.run(&[1, 2, 3, 3], &x)[0].assert_near(&[1, 3], &[4.0, 1.0, 5.0]);
    assert!(!model.operators().contains(&"Transpose".to_owned()));
}

#[test]
fn the_largest_of_a_heat_map_are_found_without_moving_it() {
    let mut model = stored_channels_first(2, 4, 3);
    model.ints("shape", &[2], &[1, -1]).ints("k", &[], &[3]);
    model.node("flat", "Reshape", &["map", "shape"], NONE());
    model.node("values", "TopKV2", &["flat", "k"], json!({"sorted": {"b": true}})).output("values");
    model.node("positions", "Identity", &["values:1"], NONE()).output("positions");
    let x = noise(24);
    let mut order: Vec<usize> = (0..24).collect();
    order.sort_by(|&a, &b| x[b].total_cmp(&x[a]));
    let outputs = model.run(&[1, 2, 4, 3], &x);
    outputs[0].assert_near(&[1, 3], &order[..3].iter().map(|&i| i as f32).collect::<Vec<_>>());
    outputs[1].assert_near(&[1, 3], &order[..3].iter().map(|&i| x[i]).collect::<Vec<_>>());
    assert!(!model.operators().contains(&"Transpose".to_owned()));
}

#[test]
fn operands_of_different_rank_and_order_meet() {
    // map [1, 2, 2, 3] + mean over the image [1, 1, 1, 3] * row [2, 1] (computed).
    let mut model = stored_channels_first(2, 2, 3);
    model.ints("image", &[2], &[1, 2]).ints("rows", &[3], &[0, 2, 3]).ints("shape", &[2], &[2, 1]);
    model.node("mean", "Mean", &["map", "image"], json!({"keep_dims": {"b": true}}));
    model.node("row", "Mean", &["map", "rows"], json!({"keep_dims": {"b": false}}));
    model.node("column", "Reshape", &["row", "shape"], NONE());
    model.node("wide", "ExpandDims", &["column", "axis"], NONE()).ints("axis", &[], &[2]);
    model.node("product", "Mul", &["mean", "wide"], NONE());
    model.node("y", "AddV2", &["map", "product"], NONE()).output("y");
    let x = noise(12);
    let mean = |c: usize| (0..4).map(|p| x[p * 3 + c]).sum::<f32>() / 4.0;
    let row = |r: usize| x[r * 6..r * 6 + 6].iter().sum::<f32>() / 6.0;
    // TensorFlow broadcasts [2, 1, 1] over [1, 1, 1, 3] to [1, 2, 1, 3].
    let at = |c: usize, r: usize, s: usize| x[(r * 2 + s) * 3 + c] + mean(c) * row(r);
    let expected: Vec<f32> =
        (0..12).map(|i| (i / 4, i / 2 % 2, i % 2)).map(|(c, r, s)| at(c, r, s)).collect();
    model.run(&[1, 2, 2, 3], &x)[0].assert_near(&[1, 3, 2, 2], &expected);
}

#[test]
fn parts_and_joins_follow_tensorflows_axes() {
    let mut model = stored_channels_first(2, 2, 3);
    model.ints("axis", &[], &[3]).ints("begin", &[4], &[0, 1, 0, 0]).ints("end", &[4], &[0, 2, 0, 2]).ints(
        "step",
        &[4],
        &[1; 4],
    );
    model.node("parts", "Split", &["axis", "map"], json!({"num_split": {"i": "3"}}));
    model.node("joined", "ConcatV2", &["parts:2", "parts", "axis"], NONE());
    // joined[:, 1, :, 0:2] without the second axis.
    let masks = json!({"begin_mask": {"i": "5"}, "end_mask": {"i": "5"}, "shrink_axis_mask": {"i": "2"}});
    model.node("y", "StridedSlice", &["joined", "begin", "end", "step"], masks).output("y");
    model.node("first", "Unpack", &["joined"], json!({"axis": {"i": "1"}, "num": {"i": "2"}}));
    model.node("packed", "Pack", &["first:1", "first"], json!({"axis": {"i": "0"}})).output("packed");
    let x: Vec<f32> = (0..12).map(|i| i as f32).collect();
    let outputs = model.run(&[1, 2, 2, 3], &x);
    outputs[0].assert_near(&[2, 1, 2, 2], &[8.0, 6.0, 11.0, 9.0, 2.0, 0.0, 5.0, 3.0]);
    outputs[1].assert_near(&[1, 2, 2], &[8.0, 6.0, 11.0, 9.0]);
}

#[test]
fn shapes_are_those_of_tensorflow() {
    let mut model = Tiny::with_input(&[1, -1, -1, 3]);
    model.floats("w", &[1, 1, 3, 2], &noise(6));
    model.node("map", "Conv2D", &["x", "w"], conv(1, "SAME"));
    model.node("shape", "Shape", &["map"], NONE()).output("shape");
    model.node("flat", "Reshape", &["map", "all"], NONE()).ints("all", &[2], &[1, -1]).output("flat");
    let outputs = model.run(&[1, 4, 5, 3], &noise(60));
    assert_eq!(outputs[0].dims, [1, 40]);
    outputs[1].assert_near(&[4], &[1.0, 4.0, 5.0, 2.0]);
}

#[test]
fn image_outputs_are_channels_first_and_vectors_unchanged() {
    let mut model = stored_channels_first(2, 2, 1);
    model.ints("image", &[2], &[1, 2]);
    model.node("mask", "Sigmoid", &["map"], NONE()).output("mask");
    model.node("mean", "Mean", &["map", "image"], json!({"keep_dims": {"b": true}})).output("mean");
    let outputs = model.run(&[1, 2, 2, 3], &[0.0; 12]);
    assert_eq!(
        (outputs[0].dims.as_slice(), outputs[1].dims.as_slice()),
        (&[1, 1, 2, 2][..], &[1, 1, 1, 1][..])
    );
}

#[test]
fn the_size_of_images_can_be_fixed_and_outputs_chosen() {
    let mut model = Tiny::with_input(&[1, -1, -1, 3]);
    model.floats("w", &[3, 3, 3, 2], &noise(54));
    model.node("a", "Conv2D", &["x", "w"], conv(2, "SAME")).output("a");
    model.node("b", "Relu", &["a"], NONE()).output("b");
    let options = ImportOptions { image_size: Some((10, 12)), outputs: vec!["a".to_owned()] };
    let onnx = onnx_from_tfjs(&model.json(), &[&model.bytes], &options).unwrap();
    let graph = opendr_onnx::model_from_bytes(&onnx).unwrap().graph.unwrap();
    assert_eq!((graph.node.len(), graph.output.len()), (1, 1));
    assert_eq!(graph.node[0].ints("pads"), Some(&[0, 0, 1, 1][..]));
    let options = ImportOptions { outputs: vec!["c".to_owned()], ..ImportOptions::default() };
    let error = onnx_from_tfjs(&model.json(), &[&model.bytes], &options).unwrap_err();
    assert_eq!(error.to_string(), "the model has no output \"c\"; it has a, b");
}

#[test]
fn the_same_model_gives_the_same_bytes() {
    let mut model = stored_channels_first(4, 4, 6);
    model.node("a", "Relu6", &["map"], NONE()).output("a");
    model.node("b", "Sigmoid", &["map"], NONE()).output("b");
    assert_eq!(model.import().unwrap(), model.import().unwrap());
}
