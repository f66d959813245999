//! Damaged and malicious ONNX files cause errors, never a panic. Alone in its process: it opens thousands of sessions.

#![allow(clippy::unwrap_used)]

use opendr_detection::object_detection_2d::ImportedDetector;
use opendr_onnx::proto::StringStringEntryProto;
use opendr_onnx::{Builder, ElementType, GraphTensor, Operator, bytes_from_model, model_from_graph};
use opendr_perception_testing::mutations::check_mutations;

/// Number of mutated files.
const MUTATIONS: usize = 20_000;

/// A network of 32 x 32 pixels with the 21 candidates of a YOLO of 3 classes, in about 500 bytes; with prototypes of masks, or with angles, for
/// these tasks.
fn network(task: &str) -> Vec<u8> {
    let mut graph = Builder::default();
    let dims = |dims: &[usize]| dims.iter().copied().map(Some).collect::<Vec<_>>();
    let x = graph.input("images", ElementType::Float, dims(&[1, 3, 32, 32]), &[]);
    let mut pool = |name: &str, kernel: [i64; 2], strides: [i64; 2], size: [usize; 2]| {
        let pool = Operator::new("AveragePool").ints("kernel_shape", kernel).ints("strides", strides);
        graph.add(name, pool, &[&x], ElementType::Float, dims(&[1, 3, size[0], size[1]])).unwrap()
    };
    let (fields, pooled) = match task {
        "segment" => (10, pool("pooled", [8, 5], [4, 3], [7, 10])),
        "obb" => (8, pool("pooled", [8, 4], [4, 4], [7, 8])),
        _ => (7, pool("pooled", [8, 8], [4, 4], [7, 7])),
    };
    let prototypes = (task == "segment").then(|| pool("prototypes", [4, 4], [4, 4], [8, 8]));
    let shape = GraphTensor::ints([1, fields, 21]);
    let rows = graph.add(
        "rows",
        Operator::new("Reshape"),
        &[&pooled, &shape],
        ElementType::Float,
        dims(&[1, fields as usize, 21]),
    );
    graph.output("output0", &rows.unwrap(), "", &[]).unwrap();
    if let Some(prototypes) = &prototypes {
        graph.output("output1", prototypes, "", &[]).unwrap();
    }
    let mut model = model_from_graph(graph.finish("detector"));
    let entry = |(key, value): (&str, &str)| StringStringEntryProto { key: key.into(), value: value.into() };
    let metadata = [("names", "{0: 'ball', 1: \"cone\", 2: 'door'}"), ("stride", "32"), ("task", task)];
    model.metadata_props = metadata.map(entry).into();
    bytes_from_model(&model)
}

#[test]
fn mutations_never_panic() {
    check_mutations::<ImportedDetector>(&["detect", "segment", "obb"].map(network), MUTATIONS);
}
