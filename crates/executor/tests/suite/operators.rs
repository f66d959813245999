//! What is refused, and graphs whose results are known.

use opendr_engine::ErrorKind;
use opendr_executor::{Data, Executor, Tensor, supported_operators};
use opendr_kernels::Compute;
use opendr_onnx::proto::{GraphProto, NodeProto};
use opendr_onnx::{
    Builder, ElementType, GraphTensor, Operator, bytes_from_model, model_from_bytes, model_from_graph,
};

fn one_node(operator: &str) -> Vec<u8> {
    let mut graph = Builder::default();
    let x = graph.input("x", ElementType::Float, vec![Some(2)], &[]);
    let y = graph.add("y", Operator::new("Relu"), &[&x], ElementType::Float, vec![Some(2)]).unwrap();
    graph.output("y", &y, "", &[]).unwrap();
    let mut model = model_from_graph(graph.finish("one"));
    model.graph.as_mut().unwrap().node[0].op_type = operator.to_owned();
    bytes_from_model(&model)
}

#[test]
fn an_unknown_operator_is_named() {
    let error = Executor::open(&one_node("Hardmax"), Compute::single()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    assert!(error.to_string().contains("Hardmax"), "{error}");
    assert!(supported_operators().any(|name| name == "Conv"));
}

#[test]
fn a_cycle_and_a_missing_value_are_errors() {
    let bytes = one_node("Relu");
    let change = |change: fn(&mut GraphProto)| {
        let mut model = model_from_bytes(&bytes).unwrap();
        change(model.graph.as_mut().unwrap());
        Executor::open(&bytes_from_model(&model), Compute::single()).unwrap_err().to_string()
    };
    let missing = change(|graph| graph.node[0].input[0] = "nothing".to_owned());
    assert!(missing.contains("nothing"), "{missing}");
    let cycle = change(|graph| {
        let output = graph.node[0].output[0].clone();
        let relu = |from: &str, to: &str| NodeProto {
            op_type: "Relu".to_owned(),
            input: vec![from.to_owned()],
            output: vec![to.to_owned()],
            ..NodeProto::default()
        };
        graph.node = vec![relu("a", "b"), relu("b", "a"), relu("a", &output)];
    });
    assert!(cycle.contains("cycle") || cycle.contains("produce"), "{cycle}");
}

#[test]
fn a_convolution_with_a_sum_and_an_activation_is_one_step() {
    let mut graph = Builder::default();
    let dims = vec![Some(1), Some(2), Some(1), Some(3)];
    let x = graph.input("x", ElementType::Float, dims.clone(), &[]);
    let weights =
        opendr_onnx::Array::new(vec![2, 2, 1, 1], opendr_onnx::Data::Float(vec![1.0, 1.0, 0.0, -1.0]))
            .unwrap();
    let weights = GraphTensor::constant(weights);
    let conv =
        graph.add("conv", Operator::new("Conv"), &[&x, &weights], ElementType::Float, dims.clone()).unwrap();
    let sum = graph.add("sum", Operator::new("Add"), &[&conv, &x], ElementType::Float, dims.clone()).unwrap();
    let relu = graph.add("relu", Operator::new("Relu"), &[&sum], ElementType::Float, dims).unwrap();
    graph.output("y", &relu, "", &[]).unwrap();
    let bytes = bytes_from_model(&model_from_graph(graph.finish("sum")));
    let mut executor = Executor::open(&bytes, Compute::single()).unwrap();
    let x = [1.0, 2.0, 3.0, -4.0, 5.0, 6.0];
    let input = [Tensor { shape: &[1, 2, 1, 3], data: Data::F32(&x) }];
    let run = executor.run(&input, &mut |outputs| {
        assert!(matches!(outputs[0].data, Data::F32([0.0, 9.0, 12.0, 0.0, 0.0, 0.0])), "{outputs:?}");
        assert_eq!(outputs[0].shape, [1, 2, 1, 3]);
        Ok(())
    });
    run.unwrap();
    // The convolution with what is fused, and the layouts at the edges.
    let mut outputs = 0;
    let layers = executor.profile(&input, &mut |all| {
        outputs += all.len();
        Ok(())
    });
    let layers = layers.unwrap();
    assert!(layers.iter().all(|layer| layer.operator == "Conv") && outputs == 1, "{layers:?}");
    assert!(layers.windows(2).all(|pair| pair[0].start + pair[0].time <= pair[1].start), "{layers:?}");
    // Two channels by two outputs for three pixels, two operations each; the sum is part of the step, whose input is read as well.
    let sums: Vec<_> = layers.iter().filter(|layer| layer.cost.float_operations > 0).collect();
    assert_eq!(sums.len(), 1, "{layers:?}");
    assert_eq!((sums[0].cost.float_operations, sums[0].cost.byte_operations), (24, 0));
    assert_eq!(sums[0].tensor_bytes, 3 * 6 * 4);
    assert!(sums[0].cost.weight_bytes >= 16, "{:?}", sums[0]);
}
