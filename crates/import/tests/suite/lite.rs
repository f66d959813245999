//! TensorFlow Lite models compute what their operators define, quantised ones to the last integer.

use crate::tiny::{convolved_same, noise, run};
use crate::tiny_lite::{FLOAT16, FLOAT32, Field, INT8, INT32, TinyLite, UINT8, raw};
use opendr_import::{ImportOptions, onnx_from_tflite};
use opendr_onnx::proto::DataType;

fn operators(model: &TinyLite) -> Vec<String> {
    model.graph().node.into_iter().map(|node| node.op_type).collect()
}

/// `SAME` padding, the given stride, an activation in field `activation`.
fn window(stride: i32, activation: (usize, u8)) -> Vec<(usize, Field)> {
    vec![(1, Field::Int(stride)), (2, Field::Int(stride)), (activation.0, Field::Byte(activation.1))]
}

/// Converts a filter from TensorFlow's order (height, width, input, output) to TensorFlow Lite's: output first.
fn output_first(w: &[f32], outputs: usize) -> Vec<f32> {
    (0..outputs).flat_map(|output| w.iter().skip(output).step_by(outputs).copied()).collect()
}

#[test]
fn a_convolution_with_bias_and_activation() {
    let (x, w) = (noise(5 * 4 * 3), noise(3 * 3 * 3 * 2));
    let mut model = TinyLite::default();
    let image = model.input(&[1, 5, 4, 3], FLOAT32);
    let filter = model.floats("w", &[2, 3, 3, 3], &output_first(&w, 2));
    let bias = model.floats("b", &[2], &[0.5, -0.25]);
    let y = model.tensor("y:0", &[1, 3, 2, 2], FLOAT32);
    model.operator(3, &[image, filter, bias], &[y], window(2, (3, 1))).outputs.push(y);
    let (dims, mut wanted) = convolved_same(&x, [5, 4, 3], &w, [3, 2, 2]);
    let half = wanted.len() / 2;
    wanted[..half].iter_mut().for_each(|value| *value = (*value + 0.5).max(0.0));
    wanted[half..].iter_mut().for_each(|value| *value = (*value - 0.25).max(0.0));
    run(model.import(), &[1, 5, 4, 3], &x)[0].assert_near(&dims, &wanted);
    assert_eq!(operators(&model), ["Conv", "Relu"]);
    assert_eq!(model.graph().output[0].name, "y");
}

#[test]
fn one_filter_per_channel_in_halves() {
    // 0.5, 1, -1, 2, 0, 0.25 for three channels with two filters each.
    let halves = [0x3800u16, 0x3c00, 0xbc00, 0x4000, 0, 0x3400];
    let mut model = TinyLite::default();
    let image = model.input(&[1, 1, 2, 3], FLOAT32);
    let half = model.constant("half", &[1, 1, 1, 6], FLOAT16, raw(&halves, u16::to_le_bytes));
    let filter = model.tensor("w", &[1, 1, 1, 6], FLOAT32);
    let y = model.tensor("y", &[1, 1, 2, 6], FLOAT32);
    model.operator(6, &[half], &[filter], Vec::new());
    model.operator(4, &[image, filter, -1], &[y], window(1, (4, 0))).outputs.push(y);
    let y = run(model.import(), &[1, 1, 2, 3], &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    y[0].assert_near(&[1, 6, 1, 2], &[0.5, 2.0, 1.0, 4.0, -2.0, -5.0, 4.0, 10.0, 0.0, 0.0, 0.75, 1.5]);
    assert_eq!(operators(&model), ["Conv"]);
}

#[test]
fn a_product_flattens_channels_last() {
    let (x, w) = (noise(8), noise(8 * 3));
    let mut model = TinyLite::default();
    let image = model.input(&[1, 2, 4, 1], FLOAT32);
    let weights = model.floats("w", &[3, 8], &w);
    let y = model.tensor("y", &[1, 3], FLOAT32);
    model.operator(9, &[image, weights, -1], &[y], Vec::new()).outputs.push(y);
    let wanted: Vec<f32> =
        w.chunks(8).map(|row| row.iter().zip(&x).map(|(w, x)| w * x).sum::<f32>()).collect();
    run(model.import(), &[1, 2, 4, 1], &x)[0].assert_near(&[1, 3], &wanted);
}

#[test]
fn a_product_may_keep_the_axes_in_front() {
    let mut model = TinyLite::default();
    let x = model.input(&[1, 2, 3], FLOAT32);
    let weights = model.floats("w", &[1, 3], &[1.0, 10.0, 100.0]);
    let y = model.tensor("y", &[1, 2, 1], FLOAT32);
    model.operator(9, &[x, weights, -1], &[y], vec![(2, Field::Byte(1))]).outputs.push(y);
    run(model.import(), &[1, 2, 3], &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])[0]
        .assert_near(&[1, 2, 1], &[321.0, 654.0]);
}

#[test]
fn rows_are_l2_normalised() {
    let mut model = TinyLite::default();
    let x = model.input(&[2, 2], FLOAT32);
    let y = model.tensor("y", &[2, 2], FLOAT32);
    model.operator(11, &[x], &[y], Vec::new()).outputs.push(y);
    run(model.import(), &[2, 2], &[3.0, -4.0, 0.0, 0.0])[0].assert_near(&[2, 2], &[0.6, -0.8, 0.0, 0.0]);
}

/// An image of bytes, weights with a scale per filter, and a result of bytes with a lower limit of zero.
fn quantised() -> TinyLite {
    let mut model = TinyLite::default();
    let image = model.input(&[1, 1, 2, 3], UINT8);
    model.quantise(image, &[0.5], &[128], 0);
    let filter = model.constant("w", &[2, 1, 1, 3], INT8, vec![3, 0xfe, 4, 1, 127, 0xff]);
    model.quantise(filter, &[0.25, 0.125], &[0, 0], 0);
    let bias = model.ints("b", &[2], &[8, -16]);
    model.quantise(bias, &[0.125, 0.0625], &[0, 0], 0);
    let y = model.tensor("y", &[1, 1, 2, 2], INT8);
    model.quantise(y, &[0.5], &[-128], 0);
    model.operator(3, &[image, filter, bias], &[y], window(1, (3, 1))).outputs.push(y);
    model
}

#[test]
fn quantised_numbers_are_rounded_where_the_original_rounds() {
    let model = quantised();
    assert_eq!(
        operators(&model),
        [
            "QuantizeLinear",
            "DequantizeLinear",
            "DequantizeLinear",
            "DequantizeLinear",
            "Conv",
            "QuantizeLinear",
            "DequantizeLinear"
        ]
    );
    let graph = model.graph();
    let filter =
        graph.initializer.iter().find(|tensor| tensor.raw_data == [3, 0xfe, 4, 1, 127, 0xff]).unwrap();
    assert_eq!((filter.data_type, filter.dims.as_slice()), (DataType::Int8 as i32, &[2, 3, 1, 1][..]));
    let x: [f32; 6] = [1.0, 2.2, -3.0, 7.3, 1000.0, -0.4];
    let steps = x.map(|value| (value / 0.5).round_ties_even().clamp(-128.0, 127.0) * 0.5);
    let filters = [([0.75, -0.5, 1.0], 1.0), ([0.125, 15.875, -0.125], -1.0)];
    let wanted: Vec<f32> = filters
        .iter()
        .flat_map(|(weights, bias)| {
            steps.chunks(3).map(move |pixel| {
                let sum: f32 = pixel.iter().zip(weights).map(|(x, w)| x * w).sum::<f32>() + bias;
                (sum / 0.5).round_ties_even().clamp(0.0, 255.0) * 0.5
            })
        })
        .collect();
    run(model.import(), &[1, 1, 2, 3], &x)[0].assert_near(&[1, 2, 1, 2], &wanted);
}

#[test]
fn unquantised_integers_are_unchanged() {
    let mut model = TinyLite::default();
    let x = model.input(&[4], FLOAT32);
    let axis = model.ints("axis", &[1], &[0]);
    let y = model.tensor("y", &[], INT32);
    model.operator(56, &[x, axis], &[y], Vec::new()).outputs.push(y);
    run(model.import(), &[4], &[0.0, 3.0, 9.0, 1.0])[0].assert_near(&[], &[2.0]);
}

#[test]
fn a_transposed_convolution_with_bias() {
    let mut model = TinyLite::default();
    let image = model.input(&[1, 1, 2, 1], FLOAT32);
    let size = model.ints("size", &[4], &[1, 2, 4, 1]);
    let filter = model.floats("w", &[1, 2, 2, 1], &[1.0, 2.0, 3.0, 4.0]);
    let bias = model.floats("b", &[1], &[10.0]);
    let y = model.tensor("y", &[1, 2, 4, 1], FLOAT32);
    model.operator(67, &[size, filter, image, bias], &[y], window(2, (3, 0))).outputs.push(y);
    let wanted = [11.0, 12.0, 12.0, 14.0, 13.0, 14.0, 16.0, 18.0];
    run(model.import(), &[1, 1, 2, 1], &[1.0, 2.0])[0].assert_near(&[1, 1, 2, 4], &wanted);
}

#[test]
fn unneeded_operators_are_omitted() {
    let mut model = TinyLite::default();
    let x = model.input(&[2], FLOAT32);
    let [y, z] = ["y", "z"].map(|name| model.tensor(name, &[2], FLOAT32));
    model.operator(101, &[x], &[y], Vec::new()).operator(9999, &[y], &[z], Vec::new());
    model.outputs.extend([y, z]);
    let options = ImportOptions { outputs: vec!["y".to_owned()], ..ImportOptions::default() };
    assert!(onnx_from_tflite(&model.bytes(), &options).is_ok());
    let error = onnx_from_tflite(&model.bytes(), &ImportOptions::default()).unwrap_err().to_string();
    assert!(error.contains("operator 1 (number 9999), which produces \"z\""), "{error}");
}
