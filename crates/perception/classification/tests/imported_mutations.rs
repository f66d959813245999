//! Damaged and malicious ONNX files cause errors, never a panic. Alone in its process: it opens thousands of sessions.

#![allow(clippy::unwrap_used)]

use opendr_classification::image_classification::{
    ImportedClassifier, ImportedZeroShotClassifier, ImportedZeroShotClassifierParams,
};
use opendr_onnx::proto::StringStringEntryProto;
use opendr_onnx::{
    Array, Builder, Data, ElementType, GraphTensor, Operator, bytes_from_model, model_from_graph,
};
use opendr_perception_common::exported_network::{InputColour, InputLevels, InputResize};
use opendr_perception_testing::mutations::{check_container_mutations, check_mutations};

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
    check_zero_shot();
}

/// Returns a network of images and texts: the means of the channels, and the sums of the tokens times weights.
fn both() -> Vec<u8> {
    let mut graph = Builder::default();
    let float = ElementType::Float;
    let tokens = graph.input("input_ids", ElementType::Int, [1, 8].map(Some).to_vec(), &[]);
    let image = graph.input("pixel_values", float, [1, 3, 16, 16].map(Some).to_vec(), &[]);
    let vector = || [1, 3].map(Some).to_vec();
    let mean = Operator::new("ReduceMean").ints("axes", 2..4).int("keepdims", 0);
    let image = graph.add("image", mean, &[&image], float, vector()).unwrap();
    let cast = Operator::new("Cast").int("to", 1);
    let tokens = graph.add("floats", cast, &[&tokens], float, [1, 8].map(Some).to_vec()).unwrap();
    let weights = Data::Float((0..24).map(|weight| weight as f32 * 0.1 - 1.0).collect());
    let weights = GraphTensor::constant(Array::new(vec![8, 3], weights).unwrap());
    let text = graph.add("text", Operator::new("MatMul"), &[&tokens, &weights], float, vector()).unwrap();
    let across = Operator::new("Transpose").ints("perm", [1, 0]);
    let across = graph.add("across", across, &[&text], float, [3, 1].map(Some).to_vec()).unwrap();
    let one = || [1, 1].map(Some).to_vec();
    let cosine = graph.add("cosine", Operator::new("MatMul"), &[&image, &across], float, one()).unwrap();
    let logits = graph
        .add("logits", Operator::new("Mul"), &[&cosine, &GraphTensor::scalar(5.0)], float, one())
        .unwrap();
    for (name, output) in [("image_embeds", &image), ("text_embeds", &text), ("logits_per_image", &logits)] {
        graph.output(name, output, "", &[]).unwrap();
    }
    bytes_from_model(&model_from_graph(graph.finish("clip")))
}

/// Mutates networks and tokenizers of zero-shot classification.
fn check_zero_shot() {
    let characters = || (0..=255).map(opendr_perception_common::byte_pairs::character_of);
    let ends = characters().map(|character| format!("{character}</w>"));
    let words = ["at</w>", "<|startoftext|>", "<|endoftext|>"].map(String::from);
    let words = characters().map(String::from).chain(ends).chain(words).zip(0..);
    let vocabulary: serde_json::Map<_, _> =
        words.map(|(word, id): (String, u32)| (word, id.into())).collect();
    let vocabulary = serde_json::Value::from(vocabulary).to_string().into_bytes();
    let merges = b"#version: 0.2\na t</w>\n".to_vec();
    let text = [("text.onnx", both())];
    let files = |others: &[(&'static str, Vec<u8>)]| {
        let own =
            [("model.onnx", both()), ("vocab.json", vocabulary.clone()), ("merges.txt", merges.clone())];
        [&own, others].concat()
    };
    let mut params =
        ImportedZeroShotClassifierParams { labels: "cat; red door".into(), ..Default::default() };
    params.input.resize = InputResize::Stretch;
    params.input.colour = InputColour::Rgb;
    params.input.levels = InputLevels::Clip;
    let containers = [files(&[]), files(&text)];
    check_container_mutations::<ImportedZeroShotClassifier>(&containers, &params, MUTATIONS / 8);
}
