//! Damaged and malicious ONNX files cause errors, never a panic. Alone in its process: it opens thousands of sessions.

#![allow(clippy::unwrap_used)]

use opendr_onnx::{Builder, ElementType, Operator, bytes_from_model, model_from_graph};
use opendr_perception_testing::mutations::check_mutations;
use opendr_segmentation::semantic_segmentation::ImportedSegmenter;

/// Number of mutated files.
const MUTATIONS: usize = 20_000;

#[test]
fn mutations_never_panic() {
    let mut graph = Builder::default();
    let shape = [1, 3, 16, 16].map(Some).to_vec();
    let image = graph.input("input", ElementType::Float, shape.clone(), &[]);
    let scores = graph
        .add("scores", Operator::new("Softmax").int("axis", 1), &[&image], ElementType::Float, shape)
        .unwrap();
    graph.output("out", &scores, "", &[]).unwrap();
    let model = model_from_graph(graph.finish("segmenter"));
    check_mutations::<ImportedSegmenter>(&[bytes_from_model(&model)], MUTATIONS);
}
