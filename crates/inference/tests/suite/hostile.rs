//! Damaged and hostile models: both runtimes return an error; no panic escapes and the process survives.

use std::slice::from_ref;
use std::sync::Arc;

use crate::test_data::test_data;
use opendr_engine::{Device, ErrorKind, Result};
use opendr_inference::{ElementType, Runtime, Session, SessionOptions, TensorView, runtimes};

const OPTIONS: SessionOptions = SessionOptions { device: Device::Cpu, threads: 1 };

fn open(runtime: &Arc<dyn Runtime>, model: &[u8]) -> Result<Session> {
    Session::open_with(&**runtime, model, OPTIONS)
}

/// Returns the error kind that every runtime reports for a model.
fn refused(what: &str, model: &[u8]) -> ErrorKind {
    let kinds: Vec<_> = runtimes()
        .iter()
        .map(|runtime| match open(runtime, model) {
            Ok(_) => panic!("{} opens {what}", runtime.name()),
            Err(error) => {
                assert!(!error.message().is_empty());
                error.kind()
            }
        })
        .collect();
    assert!(kinds.iter().all(|kind| *kind == kinds[0]), "{what}: {kinds:?}");
    kinds[0]
}

fn varint(mut value: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
    bytes
}

/// Encodes a field with bytes, text or a message.
fn field(number: u64, bytes: &[u8]) -> Vec<u8> {
    [varint(number << 3 | 2), varint(bytes.len() as u64), bytes.to_vec()].concat()
}

/// Encodes a field with an integer.
fn number(number: u64, value: u64) -> Vec<u8> {
    [varint(number << 3), varint(value)].concat()
}

fn tensor(name: &str, dims: &[u64], data_type: u64, raw: &[u8]) -> Vec<u8> {
    let dims: Vec<u8> = dims.iter().flat_map(|&dim| number(1, dim)).collect();
    [dims, number(2, data_type), field(8, name.as_bytes()), field(9, raw)].concat()
}

fn node(kind: &str, inputs: &[&str], output: &str) -> Vec<u8> {
    let inputs: Vec<u8> = inputs.iter().flat_map(|input| field(1, input.as_bytes())).collect();
    [inputs, field(2, output.as_bytes()), field(4, kind.as_bytes())].concat()
}

/// Returns a model from `x` to `y`, floats of shape `[2]`, of these nodes and weights.
fn model(nodes: &[Vec<u8>], weights: &[Vec<u8>]) -> Vec<u8> {
    model_with_output(2, nodes, weights)
}

/// Returns a model whose output declares the shape `[side]`.
fn model_with_output(side: i64, nodes: &[Vec<u8>], weights: &[Vec<u8>]) -> Vec<u8> {
    let info = |name: &str, side: i64| {
        let shape = field(2, &field(1, &number(1, side.cast_unsigned())));
        [field(1, name.as_bytes()), field(2, &field(1, &[number(1, 1), shape].concat()))]
    };
    let mut graph: Vec<u8> = nodes.iter().flat_map(|node| field(1, node)).collect();
    graph.extend(field(2, b"graph"));
    graph.extend(weights.iter().flat_map(|weight| field(5, weight)));
    graph.extend([field(11, &info("x", 2).concat()), field(12, &info("y", side).concat())].concat());
    [number(1, 8), field(7, &graph), field(8, &number(2, 13))].concat()
}

#[test]
fn the_plain_model_of_these_tests_runs() {
    let add = node("Add", &["x", "w"], "y");
    let weight = tensor("w", &[2], 1, &[1.0_f32, 2.0].map(f32::to_le_bytes).concat());
    for runtime in runtimes() {
        let session = open(&runtime, &model(from_ref(&add), from_ref(&weight))).unwrap();
        let mut sum: Vec<f32> = Vec::new();
        let input = TensorView::new(&[2], &[10.0_f32, 20.0]).unwrap();
        session
            .run(&[input], |outputs| {
                sum.extend(outputs[0].values::<f32>()?);
                Ok(())
            })
            .unwrap();
        assert_eq!(sum, [11.0, 22.0], "{}", runtime.name());
    }
}

#[test]
fn files_that_are_not_models_are_rejected() {
    for bytes in
        [&b""[..], b"hello, I am a text file", &[0; 1000], &[0xff; 1000], b"\x89PNG\r\n\x1a\n", b"RTEN"]
    {
        assert_eq!(refused("no model", bytes), ErrorKind::Format);
    }
}

#[test]
fn missing_weights_are_rejected() {
    let add = node("Add", &["x", "w"], "y");
    for dims in [&[1 << 28][..], &[1 << 32, 1 << 32], &[u64::MAX], &[3]] {
        let weight = tensor("w", dims, 1, &[0; 8]);
        assert_eq!(refused("short weights", &model(from_ref(&add), &[weight])), ErrorKind::Format);
    }
    let location = [field(1, b"location"), field(2, b"/etc/passwd")].concat();
    let weight = [tensor("w", &[2], 1, &[]), field(13, &location), number(14, 1)].concat();
    assert_eq!(
        refused("weights elsewhere", &model(from_ref(&add), from_ref(&weight))),
        ErrorKind::Unsupported
    );
    let attribute = [field(1, b"value"), field(5, &weight), number(20, 4)].concat();
    let constant = [node("Constant", &[], "w"), field(5, &attribute)].concat();
    assert_eq!(refused("a constant elsewhere", &model(&[constant, add], &[])), ErrorKind::Unsupported);
}

#[test]
fn negative_dimensions_are_rejected() {
    let add = node("Add", &["x", "x"], "y");
    for side in [-2, -5, i64::MIN] {
        let model = model_with_output(side, from_ref(&add), &[]);
        assert_eq!(refused("a negative dimension", &model), ErrorKind::Format);
    }
    // Old exporters write -1 for an unknown dimension.
    for runtime in runtimes() {
        open(&runtime, &model_with_output(-1, from_ref(&add), &[])).unwrap();
    }
}

#[test]
fn graphs_nested_without_end_are_refused() {
    let mut inner = node("Identity", &["x"], "y");
    for _ in 0..10_000 {
        let attribute = [field(1, b"body"), field(6, &field(1, &inner)), number(20, 5)].concat();
        inner = [node("Loop", &["x"], "y"), field(5, &attribute)].concat();
    }
    assert_eq!(refused("nested graphs", &model(&[inner], &[])), ErrorKind::Format);
}

#[test]
fn unknown_operator_is_unsupported() {
    let kind = refused("an unknown operator", &model(&[node("Frobnicate", &["x"], "y")], &[]));
    assert_eq!(kind, ErrorKind::Unsupported);
}

/// Tensors of 2^40 elements: rejected when opened or run; the process survives.
#[test]
fn tensors_too_large_for_memory_are_rejected() {
    let sizes = |values: &[i64]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<_>>();
    let size = |values: &[i64]| tensor("s", &[values.len() as u64], 7, &sizes(values));
    let huge = [1 << 20, 1 << 20];
    let one = tensor("one", &[1, 1], 1, &1.0_f32.to_le_bytes());
    let sum = |from: &str| [node("ReduceSum", &[from], "r"), field(5, &keep_dims_off())].concat();
    let add = node("Add", &["x", "r"], "y");
    for (what, nodes, weights) in [
        (
            "Expand",
            vec![node("Expand", &["one", "s"], "b"), sum("b"), add.clone()],
            vec![size(&huge), one.clone()],
        ),
        (
            "ConstantOfShape",
            vec![node("ConstantOfShape", &["s"], "b"), sum("b"), add.clone()],
            vec![size(&huge)],
        ),
        ("Tile", vec![node("Tile", &["one", "s"], "b"), sum("b"), add], vec![size(&huge), one]),
        ("Tile of the input", vec![node("Tile", &["x", "s"], "b"), sum_to_y()], vec![size(&[1 << 40])]),
    ] {
        for runtime in runtimes() {
            let result = open(&runtime, &model(&nodes, &weights))
                .and_then(|session| session.run(&[TensorView::new(&[2], &[0.0_f32; 2])?], |_| Ok(())));
            assert!(result.is_err(), "{} runs {what}", runtime.name());
        }
    }
}

fn keep_dims_off() -> Vec<u8> {
    [field(1, b"keepdims"), number(3, 0), number(20, 2)].concat()
}

fn sum_to_y() -> Vec<u8> {
    [node("ReduceSum", &["b"], "y"), field(5, &keep_dims_off())].concat()
}

#[test]
fn truncated_models_are_refused() {
    let Some(root) = test_data() else { return };
    for file in ["face_detection/yunet_n_320_320.onnx", "facial_expression/emotion_7cls_gray64.onnx"] {
        let model = std::fs::read(root.join("models").join(file)).unwrap();
        for part in 0..64 {
            let cut = model.len() * part / 64 + part % 7;
            assert_eq!(
                refused(file, &model[..cut.min(model.len() - 1)]),
                ErrorKind::Format,
                "{file} cut at {cut}"
            );
        }
    }
}

/// Bytes changed in the structure of the model, not in its weights.
#[test]
fn altered_models_open_or_are_refused() {
    let Some(root) = test_data() else { return };
    let model = std::fs::read(root.join("models/face_detection/yunet_n_320_320.onnx")).unwrap();
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    };
    // The nodes precede the weights.
    let outline = 20_000;
    let mut opened = 0;
    for _ in 0..300 {
        let mut altered = model.clone();
        for _ in 0..=random(3) {
            let at = random(outline);
            altered[at] = if random(2) == 0 { random(256) as u8 } else { altered[at] ^ (1 << random(8)) };
        }
        for runtime in runtimes() {
            let Ok(session) = open(&runtime, &altered) else { continue };
            opened += 1;
            let [input] = session.inputs() else { continue };
            let dims: Vec<usize> = input.dims.iter().map(|dim| dim.unwrap_or(1)).collect();
            let elements: usize = dims.iter().product();
            if input.element_type == ElementType::F32 && elements <= 1_000_000 {
                let elements = vec![0.5_f32; elements];
                let _ = session.run(&[TensorView::new(&dims, &elements).unwrap()], |_| Ok(()));
            }
        }
    }
    assert!(opened > 0);
}
