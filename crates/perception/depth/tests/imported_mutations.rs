//! Damaged and malicious ONNX files cause errors, never a panic. Alone in its process: it opens thousands of sessions.

#![allow(clippy::unwrap_used)]

use opendr_depth::depth_estimation::ImportedDepthEstimator;
use opendr_onnx::{
    Array, Builder, Data, ElementType, GraphTensor, Operator, bytes_from_model, model_from_graph,
};
use opendr_perception_testing::mutations::check_mutations;

/// Number of mutated files.
const MUTATIONS: usize = 20_000;

/// Returns a network that is recognised as Depth Anything, with an input of `side` pixels or of dynamic size.
fn network(side: Option<usize>) -> Vec<u8> {
    let mut graph = Builder::default();
    let image = graph.input("pixel_values", ElementType::Float, vec![Some(1), Some(3), side, side], &[]);
    let weights = Array::new(vec![1, 3, 1, 1], Data::Float(vec![0.3, 0.6, 0.1])).unwrap();
    let weights = GraphTensor::named_constant("head.conv3.weight", weights);
    let map = vec![Some(1), Some(1), side, side];
    let convolution = Operator::new("Conv");
    let depth =
        graph.add("conv3", convolution, &[&image, &weights], ElementType::Float, map.clone()).unwrap();
    let depth = graph.add("activation2", Operator::new("Relu"), &[&depth], ElementType::Float, map).unwrap();
    graph.output("predicted_depth", &depth, "", &[]).unwrap();
    bytes_from_model(&model_from_graph(graph.finish("depth_estimator")))
}

#[test]
fn mutations_never_panic() {
    check_mutations::<ImportedDepthEstimator>(&[network(Some(16)), network(None)], MUTATIONS);
}
