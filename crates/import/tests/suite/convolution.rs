//! Convolutions, pooling and resizing against their definitions.

use crate::tiny::{Tiny, conv, convolved_same, fused, noise};
use serde_json::json;

#[test]
fn same_padding_on_even_and_odd_sizes() {
    for (height, width, kernel, stride) in
        [(8, 7, 3, 2), (5, 6, 3, 1), (9, 9, 5, 2), (4, 4, 1, 2), (7, 8, 2, 3)]
    {
        let (x, w) = (noise(height * width * 3), noise(kernel * kernel * 3 * 4));
        let mut model = Tiny::with_input(&[1, height as i64, width as i64, 3]);
        model.floats("w", &[kernel, kernel, 3, 4], &w);
        model.node("y", "Conv2D", &["x", "w"], conv(stride, "SAME")).output("y");
        let (dims, expected) = convolved_same(&x, [height, width, 3], &w, [kernel, 4, stride]);
        model.run(&[1, height, width, 3], &x)[0].assert_near(&dims, &expected);
        assert_eq!(model.operators(), ["Conv"]);
    }
}

#[test]
fn same_padding_on_an_open_size() {
    let w = noise(3 * 3 * 3 * 2);
    let mut model = Tiny::with_input(&[-1, -1, -1, 3]);
    model.floats("w", &[3, 3, 3, 2], &w);
    model.node("y", "Conv2D", &["x", "w"], conv(2, "SAME")).output("y");
    for size in [6, 7] {
        let x = noise(size * size * 3);
        let (dims, expected) = convolved_same(&x, [size, size, 3], &w, [3, 2, 2]);
        model.run(&[1, size, size, 3], &x)[0].assert_near(&dims, &expected);
    }
}

#[test]
fn depthwise_filters_keep_their_order() {
    // Two filters per channel, 1 by 1: y[c * 2 + m] = x[c] * w[c][m].
    let mut model = Tiny::with_input(&[1, 2, 2, 3]);
    model.floats("w", &[1, 1, 3, 2], &[1.0, 10.0, 2.0, 20.0, 3.0, 30.0]);
    model.node("y", "DepthwiseConv2dNative", &["x", "w"], conv(1, "SAME")).output("y");
    let x: Vec<f32> = [1.0, 2.0, 3.0].repeat(4);
    let expected = [1.0, 10.0, 4.0, 40.0, 9.0, 90.0].map(|value| [value; 4]).concat();
    model.run(&[1, 2, 2, 3], &x)[0].assert_near(&[1, 6, 2, 2], &expected);
}

#[test]
fn fused_bias_and_activation() {
    type Activation = fn(f32) -> f32;
    let activations: [(&str, Activation); 5] = [
        ("Relu", |v| v.max(0.0)),
        ("Relu6", |v| v.clamp(0.0, 6.0)),
        ("Elu", |v| if v > 0.0 { v } else { v.exp() - 1.0 }),
        ("LeakyRelu", |v| if v > 0.0 { v } else { v * 0.25 }),
        ("Prelu", |v| if v > 0.0 { v } else { v * 0.5 }),
    ];
    for (name, activation) in activations {
        let mut model = Tiny::with_input(&[1, 1, 4, 1]);
        model.floats("w", &[1, 1, 1, 1], &[2.0]).floats("b", &[1], &[1.0]).floats(
            "slope",
            &[1, 1, 1],
            &[0.5],
        );
        let inputs = if name == "Prelu" { vec!["x", "w", "b", "slope"] } else { vec!["x", "w", "b"] };
        model.node("y", "_FusedConv2D", &inputs, fused(1, "VALID", &["BiasAdd", name])).output("y");
        let x = [-2.0, -0.25, 0.5, 4.0];
        model.run(&[1, 1, 4, 1], &x)[0].assert_near(&[1, 1, 1, 4], &x.map(|v| activation(2.0 * v + 1.0)));
    }
}

#[test]
fn padding_and_arithmetic_disappear_in_the_convolution() {
    let (x, w) = (noise(5 * 5 * 3), noise(3 * 3 * 3 * 3));
    let mut model = Tiny::with_input(&[1, 5, 5, 3]);
    model.floats("w", &[3, 3, 3, 3], &w).floats("scale", &[3], &[2.0, 0.5, -1.0]).floats(
        "shift",
        &[3],
        &[1.0, 2.0, 3.0],
    );
    model.ints("pads", &[4, 2], &[0, 0, 1, 1, 1, 1, 0, 0]);
    model.node("padded", "Pad", &["x", "pads"], json!({}));
    model.node("conv", "Conv2D", &["padded", "w"], conv(1, "VALID"));
    model.node("scaled", "Mul", &["scale", "conv"], json!({}));
    model.node("y", "AddV2", &["scaled", "shift"], json!({})).output("y");
    let (dims, mut expected) = convolved_same(&x, [5, 5, 3], &w, [3, 3, 1]);
    for (plane, (scale, shift)) in expected.chunks_mut(25).zip([(2.0, 1.0), (0.5, 2.0), (-1.0, 3.0)]) {
        plane.iter_mut().for_each(|value| *value = *value * scale + shift);
    }
    model.run(&[1, 5, 5, 3], &x)[0].assert_near(&dims, &expected);
    assert_eq!(model.operators(), ["Conv"]);
}

#[test]
fn arithmetic_on_a_convolution_that_others_read_stays() {
    let mut model = Tiny::with_input(&[1, 2, 2, 1]);
    model.floats("w", &[1, 1, 1, 1], &[3.0]).floats("two", &[], &[2.0]);
    model.node("a", "Conv2D", &["x", "w"], conv(1, "SAME")).output("a");
    model.node("b", "Mul", &["a", "two"], json!({})).output("b");
    let outputs = model.run(&[1, 2, 2, 1], &[1.0, 2.0, 3.0, 4.0]);
    outputs[0].assert_near(&[1, 1, 2, 2], &[3.0, 6.0, 9.0, 12.0]);
    outputs[1].assert_near(&[1, 1, 2, 2], &[6.0, 12.0, 18.0, 24.0]);
}

#[test]
fn transposed_convolution_doubles_the_size() {
    // Kernel 2, stride 2: every pixel becomes a block of the filter.
    let mut model = Tiny::with_input(&[1, 2, 2, 1]);
    model.floats("w", &[2, 2, 1, 1], &[1.0, 2.0, 3.0, 4.0]).ints("shape", &[4], &[1, 4, 4, 1]);
    model.node("y", "Conv2DBackpropInput", &["shape", "w", "x"], conv(2, "SAME")).output("y");
    let expected = [1.0, 2.0, 10.0, 20.0, 3.0, 4.0, 30.0, 40.0, 0.0, 0.0, 5.0, 10.0, 0.0, 0.0, 15.0, 20.0];
    model.run(&[1, 2, 2, 1], &[1.0, 10.0, 0.0, 5.0])[0].assert_near(&[1, 1, 4, 4], &expected);
}

#[test]
fn transposed_convolution_crops_in_front_as_the_forward_one_pads() {
    // Kernel 3, stride 2, 2 -> 4 pixels: forward padding of 4 pixels is (0, 1), so only the end is cropped.
    let mut model = Tiny::with_input(&[1, 1, 2, 1]);
    model.floats("w", &[1, 3, 1, 1], &[1.0, 2.0, 3.0]).ints("shape", &[4], &[1, 2, 4, 1]);
    model.node("y", "Conv2DBackpropInput", &["shape", "w", "x"], conv(2, "SAME")).output("y");
    let expected = [1.0, 2.0, 3.0 + 10.0, 20.0, 0.0, 0.0, 0.0, 0.0];
    model.run(&[1, 1, 2, 1], &[1.0, 10.0])[0].assert_near(&[1, 1, 2, 4], &expected);
}

#[test]
fn average_leaves_the_padding_out() {
    let mut attr = conv(1, "SAME");
    attr["ksize"] = json!({"list": {"i": ["1", "3", "3", "1"]}});
    let mut model = Tiny::with_input(&[1, 2, 2, 1]);
    model.node("mean", "AvgPool", &["x"], attr.clone()).output("mean");
    model.node("max", "MaxPool", &["x"], attr).output("max");
    let outputs = model.run(&[1, 2, 2, 1], &[-1.0, -2.0, -3.0, -6.0]);
    outputs[0].assert_near(&[1, 1, 2, 2], &[-1.0; 4]);
    outputs[1].assert_near(&[1, 1, 2, 2], &[-3.0; 4]);
}

#[test]
fn resize_in_each_coordinate_mode() {
    let cases: [(&str, bool, bool, [f32; 4]); 6] = [
        ("ResizeBilinear", false, true, [0.0, 1.0, 3.0, 4.0]),
        ("ResizeBilinear", false, false, [0.0, 2.0, 4.0, 4.0]),
        ("ResizeBilinear", true, false, [0.0, 4.0 / 3.0, 8.0 / 3.0, 4.0]),
        ("ResizeNearestNeighbor", false, true, [0.0, 0.0, 4.0, 4.0]),
        ("ResizeNearestNeighbor", false, false, [0.0, 0.0, 4.0, 4.0]),
        ("ResizeNearestNeighbor", true, false, [0.0, 0.0, 4.0, 4.0]),
    ];
    for (op, align, half, expected) in cases {
        let mut model = Tiny::with_input(&[1, 1, 2, 1]);
        model.ints("size", &[2], &[1, 4]);
        let attr = json!({"align_corners": {"b": align}, "half_pixel_centers": {"b": half}});
        model.node("y", op, &["x", "size"], attr).output("y");
        model.run(&[1, 1, 2, 1], &[0.0, 4.0])[0].assert_near(&[1, 1, 1, 4], &expected);
    }
}

#[test]
fn depth_to_space_rearranges_channels() {
    let mut model = Tiny::with_input(&[1, 1, 1, 4]);
    model.node("y", "DepthToSpace", &["x"], json!({"block_size": {"i": "2"}})).output("y");
    model.run(&[1, 1, 1, 4], &[1.0, 2.0, 3.0, 4.0])[0].assert_near(&[1, 1, 2, 2], &[1.0, 2.0, 3.0, 4.0]);
}

#[test]
fn hard_swish_is_fused_and_its_factor_folded() {
    let sixth = 0.166_625_98; // 1/6 in half precision
    let mut model = Tiny::with_input(&[1, 1, 4, 1]);
    model.floats("w", &[1, 1, 1, 1], &[2.0]).floats("v", &[1, 1, 1, 1], &[10.0]);
    model.floats("sixth", &[], &[sixth]).floats("three", &[], &[3.0]);
    model.node("a", "Conv2D", &["x", "w"], conv(1, "SAME"));
    model.node("scaled", "Mul", &["sixth", "a"], json!({}));
    model.node("shifted", "AddV2", &["a", "three"], json!({}));
    model.node("clipped", "Relu6", &["shifted"], json!({}));
    model.node("swish", "Mul", &["scaled", "clipped"], json!({}));
    model.node("y", "Conv2D", &["swish", "v"], conv(1, "SAME")).output("y");
    let x = [-2.0, -0.5, 0.25, 4.0];
    let expected = x.map(|v| 10.0 * (2.0 * v) * sixth * (2.0 * v + 3.0f32).clamp(0.0, 6.0));
    model.run(&[1, 1, 4, 1], &x)[0].assert_near(&[1, 1, 1, 4], &expected);
    assert_eq!(model.operators(), ["Conv", "HardSwish", "Conv"]);
}

#[test]
fn a_factor_stays_where_it_would_change_something_else() {
    let mut model = Tiny::with_input(&[1, 1, 2, 1]);
    model.floats("w", &[1, 1, 1, 1], &[2.0]).floats("half", &[], &[0.5]);
    model.node("relu", "Sigmoid", &["x"], json!({}));
    model.node("halved", "Mul", &["relu", "half"], json!({}));
    model.node("a", "Conv2D", &["halved", "w"], conv(1, "SAME")).output("a");
    model.node("b", "Exp", &["halved"], json!({})).output("b");
    let sigmoid = [-1.0f32, 2.0].map(|v| 1.0 / (1.0 + (-v).exp()));
    let outputs = model.run(&[1, 1, 2, 1], &[-1.0, 2.0]);
    outputs[0].assert_near(&[1, 1, 1, 2], &sigmoid);
    outputs[1].assert_near(&[1, 1, 1, 2], &sigmoid.map(|v| (v / 2.0).exp()));
}
