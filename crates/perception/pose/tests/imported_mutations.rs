//! Damaged and malicious ONNX files cause errors, never a panic. Alone in its process: it opens thousands of sessions.

#![allow(clippy::unwrap_used)]

use opendr_onnx::proto::StringStringEntryProto;
use opendr_onnx::{Builder, ElementType, GraphTensor, Operator, bytes_from_model, model_from_graph};
use opendr_perception_testing::mutations::check_mutations;
use opendr_pose::pose_estimation::{ImportedPoseEstimator, ImportedTopDownPoseEstimator};

/// Number of mutated files.
const MUTATIONS: usize = 20_000;

/// A network of 32 x 32 pixels whose outputs of these shapes are averages of its input.
fn network(outputs: &[(&str, &[usize])], metadata: &[(&str, &str)]) -> Vec<u8> {
    let mut graph = Builder::default();
    let dims = |dims: &[usize]| dims.iter().copied().map(Some).collect::<Vec<_>>();
    let x = graph.input("images", ElementType::Float, dims(&[1, 3, 32, 32]), &[]);
    let pool = Operator::new("AveragePool").ints("kernel_shape", [8, 5]).ints("strides", [4, 2]);
    let pooled = graph.add("pooled", pool, &[&x], ElementType::Float, dims(&[1, 3, 7, 14])).unwrap();
    let mut add = |name: &'static str, inputs: &[&GraphTensor], shape: &[usize]| {
        graph.add(name, Operator::new(name), inputs, ElementType::Float, dims(shape)).unwrap()
    };
    let flat = add("Reshape", &[&pooled, &GraphTensor::ints([294])], &[294]);
    let mut rows = Vec::new();
    for (_, shape) in outputs {
        let count: usize = shape.iter().product();
        let part =
            add("Slice", &[&flat, &GraphTensor::ints([0]), &GraphTensor::ints([count as i64])], &[count]);
        let shape_of = GraphTensor::ints(shape.iter().map(|side| *side as i64));
        rows.push(add("Reshape", &[&part, &shape_of], shape));
    }
    for ((name, _), rows) in outputs.iter().zip(&rows) {
        graph.output(name, rows, "", &[]).unwrap();
    }
    let mut model = model_from_graph(graph.finish("pose_estimator"));
    let entry =
        |(key, value): &(&str, &str)| StringStringEntryProto { key: (*key).into(), value: (*value).into() };
    model.metadata_props = metadata.iter().map(entry).collect();
    bytes_from_model(&model)
}

/// Metadata of Ultralytics.
fn metadata<'a>(shape: &'a str, end_to_end: &'a str) -> [(&'a str, &'a str); 5] {
    [
        ("names", "{0: 'ball', 1: \"cone\"}"),
        ("stride", "32"),
        ("task", "pose"),
        ("kpt_shape", shape),
        ("end2end", end_to_end),
    ]
}

#[test]
fn mutations_never_panic() {
    let networks = [
        network(&[("output0", &[1, 12, 21])], &metadata("[2, 3]", "False")),
        network(&[("output0", &[1, 21, 14])], &metadata("[4, 2]", "True")),
        network(&[("dets", &[1, 3, 5]), ("keypoints", &[1, 3, 4, 3])], &[]),
    ];
    check_mutations::<ImportedPoseEstimator>(&networks, MUTATIONS);
}

#[test]
fn mutations_of_top_down_networks_never_panic() {
    let networks = [
        network(&[("simcc_x", &[1, 2, 64]), ("simcc_y", &[1, 2, 64])], &[]),
        network(&[("simcc_y", &[1, 17, 5]), ("simcc_x", &[1, 17, 9])], &[]),
    ];
    check_mutations::<ImportedTopDownPoseEstimator>(&networks, MUTATIONS);
}
