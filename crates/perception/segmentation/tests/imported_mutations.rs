//! Damaged and malicious ONNX files cause errors, never a panic. Alone in its process: it opens thousands of sessions.

#![allow(clippy::unwrap_used)]

use opendr_onnx::{Builder, ElementType, GraphTensor, Operator, bytes_from_model, model_from_graph};
use opendr_perception_common::exported_network::InputLevels;
use opendr_perception_testing::mutations::{check_container_mutations, check_mutations};
use opendr_segmentation::instance_segmentation::{
    ImportedPromptableSegmenter, ImportedPromptableSegmenterParams,
};
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

const EMBEDDING: [usize; 4] = [1, 3, 8, 8];

fn dims(dims: &[usize]) -> Vec<Option<usize>> {
    dims.iter().copied().map(Some).collect()
}

fn add(graph: &mut Builder, operator: Operator, inputs: &[&GraphTensor], shape: &[usize]) -> GraphTensor {
    graph.add("node", operator, inputs, ElementType::Float, dims(shape)).unwrap()
}

fn finish(graph: Builder) -> Vec<u8> {
    bytes_from_model(&model_from_graph(graph.finish("promptable_segmenter")))
}

/// An encoder of 32 x 32 pixels whose outputs are averages of its input.
fn encoder(outputs: &[&str]) -> Vec<u8> {
    let mut graph = Builder::default();
    let image = graph.input("image", ElementType::Float, dims(&[1, 3, 32, 32]), &[]);
    for output in outputs {
        let pool = Operator::new("AveragePool").ints("kernel_shape", [4, 4]).ints("strides", [4, 4]);
        let pooled = add(&mut graph, pool, &[&image], &EMBEDDING);
        graph.output(output, &pooled, "", &[]).unwrap();
    }
    finish(graph)
}

/// Inputs and outputs of segment-anything's decoder.
fn original_decoder() -> Vec<u8> {
    let mut graph = Builder::default();
    let embedding = graph.input("image_embeddings", ElementType::Float, dims(&EMBEDDING), &[]);
    graph.input("point_coords", ElementType::Float, vec![Some(1), None, Some(2)], &[]);
    let labels = graph.input("point_labels", ElementType::Float, vec![Some(1), None], &[]);
    let mask = graph.input("mask_input", ElementType::Float, dims(&[1, 1, 8, 8]), &[]);
    let has_mask = graph.input("has_mask_input", ElementType::Float, dims(&[1]), &[]);
    graph.input("orig_im_size", ElementType::Float, dims(&[2]), &[]);
    let masks = add(&mut graph, Operator::new("Concat").int("axis", 1), &[&embedding, &mask], &[1, 4, 8, 8]);
    let means = Operator::new("ReduceMean").ints("axes", [2, 3]).int("keepdims", 0);
    let means = add(&mut graph, means, &[&masks], &[1, 4]);
    let label = add(&mut graph, Operator::new("ReduceMean").ints("axes", [1]), &[&labels], &[1, 1]);
    let label = add(&mut graph, Operator::new("Mul"), &[&label, &has_mask], &[1, 1]);
    let scores = add(&mut graph, Operator::new("Add"), &[&means, &label], &[1, 4]);
    graph.output("iou_predictions", &scores, "", &[]).unwrap();
    graph.output("low_res_masks", &masks, "", &[]).unwrap();
    finish(graph)
}

/// Inputs and outputs of the decoder of transformers.
fn transformers_decoder() -> Vec<u8> {
    let mut graph = Builder::default();
    let embedding = graph.input("image_embeddings", ElementType::Float, dims(&EMBEDDING), &[]);
    let positions = graph.input("image_positional_embeddings", ElementType::Float, dims(&EMBEDDING), &[]);
    graph.input("input_points", ElementType::Float, vec![Some(1), None, None, Some(2)], &[]);
    graph.input("input_labels", ElementType::Int, vec![Some(1), None, None], &[]);
    let sum = add(&mut graph, Operator::new("Add"), &[&embedding, &positions], &EMBEDDING);
    let masks = add(
        &mut graph,
        Operator::new("Reshape"),
        &[&sum, &GraphTensor::ints([1, 1, 3, 8, 8])],
        &[1, 1, 3, 8, 8],
    );
    let means = Operator::new("ReduceMean").ints("axes", [3, 4]).int("keepdims", 0);
    let scores = add(&mut graph, means, &[&masks], &[1, 1, 3]);
    graph.output("iou_scores", &scores, "", &[]).unwrap();
    graph.output("pred_masks", &masks, "", &[]).unwrap();
    finish(graph)
}

#[test]
fn mutations_of_promptable_networks_never_panic() {
    let containers = [
        vec![("encoder.onnx", encoder(&["embeddings"])), ("decoder.onnx", original_decoder())],
        vec![
            ("encoder.onnx", encoder(&["image_embeddings", "image_positional_embeddings"])),
            ("decoder.onnx", transformers_decoder()),
        ],
    ];
    let params = ImportedPromptableSegmenterParams {
        points: "20,10;3,4,0".into(),
        levels: InputLevels::Unit,
        ..Default::default()
    };
    check_container_mutations::<ImportedPromptableSegmenter>(&containers, &params, MUTATIONS);
}
