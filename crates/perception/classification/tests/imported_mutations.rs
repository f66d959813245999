//! Damaged and malicious ONNX files cause errors, never a panic. Alone in its process: it opens thousands of sessions.

#![allow(clippy::unwrap_used)]

use opendr_classification::image_classification::ImportedClassifier;
use opendr_onnx::proto::StringStringEntryProto;
use opendr_onnx::{Builder, ElementType, Operator, bytes_from_model, model_from_graph};
use opendr_perception_testing::mutations::check_mutations;

/// Number of mutated files.
const MUTATIONS: usize = 20_000;

#[test]
fn mutations_never_panic() {
    let mut graph = Builder::default();
    let image = graph.input("images", ElementType::Float, [1, 3, 16, 16].map(Some).to_vec(), &[]);
    let mean = Operator::new("ReduceMean").ints("axes", 2..4).int("keepdims", 0);
    let scores = [1, 3].map(Some).to_vec();
    let means = graph.add("means", mean, &[&image], ElementType::Float, scores.clone()).unwrap();
    let scores =
        graph.add("scores", Operator::new("Softmax"), &[&means], ElementType::Float, scores).unwrap();
    graph.output("output0", &scores, "", &[]).unwrap();
    let mut model = model_from_graph(graph.finish("classifier"));
    let metadata = [("names", "{0: 'ball', 1: \"cone\", 2: 'door'}"), ("stride", "1"), ("task", "classify")];
    let entry = |(key, value): (&str, &str)| StringStringEntryProto { key: key.into(), value: value.into() };
    model.metadata_props = metadata.map(entry).into();
    check_mutations::<ImportedClassifier>(&[bytes_from_model(&model)], MUTATIONS);
}
