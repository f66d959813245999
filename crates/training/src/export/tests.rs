use burn::nn::conv::Conv2dConfig;
use burn::nn::{LinearConfig, PaddingConfig2d};
use burn::tensor::module::unfold4d;
use burn::tensor::ops::UnfoldOptions;
use burn::tensor::{Device, Distribution, Int, Tensor};
use opendr_engine::ErrorKind;
use opendr_onnx::model_from_bytes;
use opendr_onnx::proto::{DimensionValue, GraphProto, TypeValue};

use super::*;

fn graph(model: Result<Vec<u8>>) -> GraphProto {
    model_from_bytes(&model.unwrap()).unwrap().graph.unwrap()
}

fn operators(graph: &GraphProto) -> Vec<&str> {
    graph.node.iter().map(|node| node.op_type.as_str()).collect()
}

fn dims(info: &opendr_onnx::proto::ValueInfoProto) -> Vec<String> {
    let Some(TypeValue::Tensor(tensor)) = info.r#type.as_ref().and_then(|r#type| r#type.value.as_ref())
    else {
        panic!("{info:?} is no tensor")
    };
    let dims = tensor.shape.iter().flat_map(|shape| &shape.dim).map(|dim| match &dim.value {
        Some(DimensionValue::Value(value)) => value.to_string(),
        Some(DimensionValue::Param(name)) => name.clone(),
        None => "?".to_owned(),
    });
    dims.collect()
}

fn linear() -> burn::nn::Linear {
    LinearConfig::new(4, 2).init(&Device::flex())
}

#[test]
fn the_model_contains_sizes_names_and_weights() {
    let input = Input::new("features", [7, 4]).open(0);
    let graph = graph(onnx(&linear(), input, &["logits"], |network, x| network.forward(x)));
    assert_eq!(operators(&graph), ["MatMul", "Add"]);
    assert_eq!(
        (graph.input[0].name.as_str(), dims(&graph.input[0])),
        ("features", vec!["batch".into(), "4".into()])
    );
    assert_eq!(
        (graph.output[0].name.as_str(), dims(&graph.output[0])),
        ("logits", vec!["batch".into(), "2".into()])
    );
    assert_eq!(graph.initializer[0].name, "weight");
}

#[test]
fn a_flattened_open_batch_is_inferred() {
    let input = Input::new("x", [1, 2, 3]).open(0);
    let graph = graph(onnx(&linear(), input, &["y"], |_, x| x.flatten::<2>(1, 2)));
    assert_eq!(operators(&graph), ["Reshape"]);
    let shape = graph.initializer.iter().find(|tensor| tensor.name == graph.node[0].input[1]).unwrap();
    assert_eq!(opendr_onnx::Array::from_tensor(shape).unwrap().as_ints(), Some(&[-1, 6][..]));
}

#[test]
fn several_inputs_and_kinds() {
    let inputs = (Input::new("table", [5, 3]), Input::int("rows", [4]));
    let graph = graph(onnx(
        &linear(),
        inputs,
        &["picked", "twice"],
        |_, (table, rows): (Tensor<2>, Tensor<1, Int>)| (table.select(0, rows.clone()), rows * 2),
    ));
    assert_eq!(operators(&graph), ["Gather", "Mul"]);
    assert_eq!(dims(&graph.output[1]), ["4"]);
}

#[test]
fn operations_without_lowering_are_named_with_their_sizes() {
    let input = Input::new("image", [1, 2, 4, 4]);
    let options = UnfoldOptions::new([1, 1], [0, 0], [1, 1]);
    let error = onnx(&linear(), input, &["y"], |_, x| unfold4d(x, [2, 2], options.clone())).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    assert!(error.message().starts_with("Unfold4d of [1, 2, 4, 4] to [1, 8, 9] has no"), "{error}");
}

#[test]
fn random_numbers_are_refused() {
    let error = onnx(&linear(), Input::new("x", [1, 4]), &["y"], |_, x| x.random_like(Distribution::Default));
    assert!(error.unwrap_err().message().starts_with("Random"), "names the operation");
}

#[test]
fn values_that_depend_on_the_batch_are_refused() {
    let refused = |forward: fn(Tensor<2>) -> Tensor<2>| {
        let error = onnx(&linear(), Input::new("x", [1, 4]).open(0), &["y"], |_, x| forward(x)).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Unsupported);
        error.to_string()
    };
    let scaled = refused(|x| {
        let [batch, _] = x.dims();
        x / batch as f32
    });
    assert!(scaled.contains("DivScalar of"), "{scaled}");
    let half = refused(|x| {
        let [batch, _] = x.dims();
        x.narrow(0, 0, batch / 2)
    });
    assert!(half.contains("Slice of"), "{half}");
    let counted = refused(|x| {
        let [batch, _] = x.dims();
        let numbers: Vec<f32> = (0..batch).map(|number| number as f32).collect();
        x.clone() + Tensor::<1>::from_floats(numbers.as_slice(), &x.device()).reshape([batch, 1])
    });
    assert!(counted.contains("constant"), "{counted}");
}

#[test]
fn a_missing_output_name_is_refused() {
    let error =
        onnx(&linear(), Input::new("x", [1, 4]), &["a", "b"], |network, x| network.forward(x)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Internal);
}

#[test]
fn an_input_can_be_an_output() {
    let graph = graph(onnx(&linear(), Input::new("x", [1, 4]), &["y"], |_, x| x));
    assert_eq!(operators(&graph), ["Identity"]);
}

#[test]
fn a_training_network_is_exported_in_inference_mode() {
    let device = Device::flex().autodiff();
    let conv = Conv2dConfig::new([1, 2], [3, 3]).with_padding(PaddingConfig2d::Same).init(&device);
    let norm = burn::nn::BatchNormConfig::new(2).init(&device);
    let dropout = burn::nn::DropoutConfig::new(0.5).init();
    let network = (conv, norm, dropout);
    let graph = graph(onnx(&network, Input::new("x", [1, 1, 5, 5]), &["y"], |(conv, norm, dropout), x| {
        dropout.forward(norm.forward(conv.forward(x)))
    }));
    assert_eq!(operators(&graph), ["Conv"]);
}
