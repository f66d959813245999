//! Damaged and malicious TensorFlow Lite models cause an error with a precise message.

use crate::tiny_lite::{FLOAT32, Field, INT8, Table, TinyLite};
use opendr_engine::ErrorKind;
use opendr_import::{ImportOptions, onnx_from_tflite};

#[track_caller]
fn refused(model: &TinyLite, kind: ErrorKind, part: &str) {
    let error = onnx_from_tflite(&model.bytes(), &ImportOptions::default()).err();
    let error = error.map(|error| (error.kind(), error.to_string()));
    assert!(error.as_ref().is_some_and(|error| error.0 == kind && error.1.contains(part)), "{error:?}");
}

/// A quantised convolution, a pooling, a concatenation, a slice and a product.
fn model() -> TinyLite {
    let mut model = TinyLite::default();
    let x = model.input(&[1, 4, 4, 3], INT8);
    model.quantise(x, &[0.5], &[3], 0);
    let w = model.constant("w", &[2, 1, 1, 3], INT8, vec![1, 2, 3, 4, 5, 6]);
    model.quantise(w, &[0.5, 0.25], &[0, 0], 0);
    let a = model.tensor("a", &[1, 4, 4, 2], INT8);
    model.quantise(a, &[0.5], &[0], 0);
    let step = |first: usize| -> Table { vec![(first, Field::Int(1)), (first + 1, Field::Int(1))] };
    model.operator(3, &[x, w, -1], &[a], step(1));
    let b = model.tensor("b", &[1, 4, 4, 2], FLOAT32);
    model.operator(6, &[a], &[b], Vec::new());
    let c = model.tensor("c", &[1, 2, 2, 2], FLOAT32);
    let pool = (1..5).map(|field| (field, Field::Int(2))).collect();
    model.operator(17, &[b], &[c], pool);
    let d = model.tensor("d", &[1, 2, 2, 4], FLOAT32);
    model.operator(2, &[c, c], &[d], vec![(0, Field::Int(-1))]);
    let [begin, end, strides] = [[0, 0, 0, 1], [1, 2, 1, 4], [1, 1, 1, 2]].map(|v| model.ints("v", &[4], &v));
    let e = model.tensor("e", &[1, 2, 1, 2], FLOAT32);
    model.operator(45, &[d, begin, end, strides], &[e], vec![(1, Field::Int(0))]);
    let v = model.floats("v", &[2, 4], &[1.0; 8]);
    let f = model.tensor("f", &[1, 2], FLOAT32);
    model.operator(9, &[e, v, -1], &[f], Vec::new()).outputs.push(f);
    model
}

#[test]
fn errors_name_the_missing_part() {
    let mut missing = model();
    missing.operators.remove(1);
    refused(&missing, ErrorKind::Format, "tensor \"b\" is needed, but no preceding operator produces it");
    let mut cycle = model();
    cycle.operators[1] = vec![(0, Field::Int(1)), (1, Field::Ints(vec![4])), (2, Field::Ints(vec![3]))];
    refused(&cycle, ErrorKind::Format, "is needed, but no preceding operator produces it");
    let mut twice = model();
    let again = twice.operators[1].clone();
    twice.operators.insert(2, again);
    refused(&twice, ErrorKind::Format, "produced twice");
    let mut short = model();
    short.buffers[1].pop();
    refused(&short, ErrorKind::Format, "tensor \"w\" of shape [2, 1, 1, 3] has 5 bytes");
    let mut unknown = model();
    unknown.outputs[0] = 99;
    refused(&unknown, ErrorKind::Format, "tensor 99 is needed, but there are");
    let mut unlisted = model();
    unlisted.codes.pop();
    refused(&unlisted, ErrorKind::Format, "does not list");
    let mut scales = model();
    scales.tensors[1].pop();
    scales.quantise(1, &[0.5, 0.25, 1.0], &[0, 0, 0], 0);
    refused(&scales, ErrorKind::Format, "3 scales do not match Some(2) positions");
    let mut nan = model();
    nan.tensors[1].pop();
    nan.quantise(1, &[f32::NAN], &[0], 0);
    refused(&nan, ErrorKind::Format, "do not match");
}

#[test]
fn sparse_weights_are_refused() {
    let mut sparse = model();
    sparse.tensors[1].push((6, Field::Table(Vec::new())));
    refused(&sparse, ErrorKind::Unsupported, "use a model with dense weights");
    let mut densify = model();
    densify.codes[1] = 124;
    refused(&densify, ErrorKind::Unsupported, "use a model with dense weights");
}

#[test]
fn small_files_cannot_ask_for_much() {
    let mut large = TinyLite::default();
    let x = large.input(&[i32::MAX; 4], FLOAT32);
    let w = large.constant("w", &[i32::MAX, i32::MAX, i32::MAX, 3], FLOAT32, vec![0; 4]);
    let y = large.tensor("y", &[1], FLOAT32);
    large.operator(0, &[x, w], &[y], Vec::new()).outputs.push(y);
    refused(&large, ErrorKind::Format, "has 4 bytes");
    // Every operator doubles the axes.
    let mut axes = TinyLite::default();
    let mut last = axes.ints("indices", &[1; 8], &[0]);
    for _ in 0..40 {
        let next = axes.tensor("y", &[1], FLOAT32);
        axes.operator(36, &[last, last], &[next], Vec::new());
        last = next;
    }
    axes.outputs.push(last);
    refused(&axes, ErrorKind::Format, "57 axes exceed the limit of 32");
    // One buffer of a megabyte for a thousand tensors, by all of which the file would take a gigabyte.
    let mut shared = TinyLite::default();
    let x = shared.input(&[1 << 18], FLOAT32);
    let first = shared.floats("w", &[1 << 18], &[1.0; 1 << 18]);
    let mut sum = x;
    for _ in 0..1000 {
        shared.tensors.push(shared.tensors[first as usize].clone());
        let constant = shared.tensors.len() as i32 - 1;
        let next = shared.tensor("y", &[1 << 18], FLOAT32);
        shared.operator(0, &[sum, constant], &[next], Vec::new());
        sum = next;
    }
    shared.outputs.push(sum);
    refused(&shared, ErrorKind::Format, "too many times");
}

/// Every byte and every word of the file damaged, and the file cut off everywhere: no panic.
#[test]
fn damage_never_panics() {
    let bytes = model().bytes();
    let import = |bytes: &[u8]| onnx_from_tflite(bytes, &ImportOptions::default()).is_ok();
    assert!(import(&bytes));
    assert!((0..bytes.len() - 8).all(|end| !import(&bytes[..end])));
    for position in 0..bytes.len() {
        for value in [0, 1, 2, 4, 127, 255, bytes[position].wrapping_add(1), bytes[position] ^ 0x80] {
            let mut damaged = bytes.clone();
            damaged[position] = value;
            import(&damaged);
        }
    }
    for word in 0..bytes.len() / 4 {
        for value in [0, -1, 4, 1 << 16, i32::MAX, i32::MIN] {
            let mut damaged = bytes.clone();
            damaged[word * 4..word * 4 + 4].copy_from_slice(&value.to_le_bytes());
            import(&damaged);
        }
    }
}
