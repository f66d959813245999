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

fn constant(shape: Vec<usize>, values: &[f32]) -> GraphTensor {
    GraphTensor::constant(opendr_onnx::Array::new(shape, opendr_onnx::Data::Float(values.to_vec())).unwrap())
}

fn outputs(executor: &mut Executor, shape: &[usize], x: &[f32]) -> Vec<Vec<f32>> {
    let mut all = Vec::new();
    let inputs = [Tensor { shape, data: Data::F32(x) }];
    let run = executor.run(&inputs, &mut |outputs| {
        for output in outputs {
            all.push(match output.data {
                Data::F32(values) => values.to_vec(),
                Data::I64(values) => values.iter().map(|&value| value as f32).collect(),
                _ => panic!("{output:?}"),
            });
        }
        Ok(())
    });
    run.unwrap();
    all
}

#[test]
fn a_product_with_a_bias_a_sum_and_an_activation_is_one_step() {
    let mut graph = Builder::default();
    let dims = vec![Some(1), Some(3), Some(2)];
    let x = graph.input("x", ElementType::Float, dims.clone(), &[]);
    let weights = constant(vec![2, 2], &[1.0, 2.0, 3.0, -1.0]);
    let bias = constant(vec![1, 1, 2], &[0.5, -8.0]);
    let mut add = |name: &str, operator: &'static str, inputs: [&GraphTensor; 2]| {
        graph.add(name, Operator::new(operator), &inputs, ElementType::Float, dims.clone()).unwrap()
    };
    let product = add("product", "MatMul", [&x, &weights]);
    let biased = add("biased", "Add", [&bias, &product]);
    let sum = add("sum", "Add", [&biased, &x]);
    let relu = graph.add("relu", Operator::new("Relu"), &[&sum], ElementType::Float, dims).unwrap();
    graph.output("y", &relu, "", &[]).unwrap();
    let bytes = bytes_from_model(&model_from_graph(graph.finish("product")));
    let mut executor = Executor::open(&bytes, Compute::single()).unwrap();
    let x = [1.0, 2.0, 0.0, 1.0, -4.0, 2.0];
    // Rows: [7, 0], [3, -1], [2, -10] + bias + x.
    assert_eq!(outputs(&mut executor, &[1, 3, 2], &x), [[8.5, 0.0, 3.5, 0.0, 0.0, 0.0]]);
    let inputs = [Tensor { shape: &[1, 3, 2], data: Data::F32(&x) }];
    let layers = executor.profile(&inputs, &mut |_| Ok(())).unwrap();
    assert_eq!(layers.len(), 1, "{layers:?}");
}

#[test]
fn a_node_between_a_product_and_its_sum_is_not_left_out() {
    // `alpha` and a matrix that is not a bias: the activation must follow the sum.
    for (alpha, rows) in [(1.0, 2), (0.5, 2), (0.5, 1)] {
        let mut graph = Builder::default();
        let dims = vec![Some(2), Some(2)];
        let x = graph.input("x", ElementType::Float, dims.clone(), &[]);
        let weights = constant(vec![2, 2], &[1.0, 0.0, 0.0, 1.0]);
        let other = constant(vec![rows, 2], &[10.0, -10.0, 20.0, -20.0][..2 * rows]);
        let gemm = Operator::new("Gemm").float("alpha", alpha);
        let gemm =
            graph.add("gemm", gemm, &[&x, &weights, &other], ElementType::Float, dims.clone()).unwrap();
        let relu = graph.add("relu", Operator::new("Relu"), &[&gemm], ElementType::Float, dims).unwrap();
        graph.output("y", &relu, "", &[]).unwrap();
        let bytes = bytes_from_model(&model_from_graph(graph.finish("gemm")));
        let mut executor = Executor::open(&bytes, Compute::single()).unwrap();
        let second = if rows == 1 { 10.0 } else { 20.0 };
        let wanted = [10.0 - alpha, 0.0, 2.0 * alpha + second, 0.0];
        assert_eq!(outputs(&mut executor, &[2, 2], &[-1.0, 4.0, 2.0, 6.0]), [wanted], "{alpha} {rows}");
    }
}

#[test]
fn the_largest_of_many_are_those_of_a_sort() {
    let mut random = opendr_engine::Random::new(5);
    for (length, k, largest) in [(10_000, 7, 1), (10_000, 100, 0), (300, 300, 1), (129, 64, 0), (5, 2, 1)] {
        let mut graph = Builder::default();
        let x = graph.input("x", ElementType::Float, vec![Some(2), Some(length)], &[]);
        let operator = Operator::new("TopK").int("largest", largest).int("axis", 1);
        let count = opendr_onnx::Array::new(vec![1], opendr_onnx::Data::Int(vec![k as i64])).unwrap();
        let count = GraphTensor::constant(count);
        let shape = vec![Some(2), Some(k)];
        let kinds = vec![(ElementType::Float, shape.clone()), (ElementType::Int, shape)];
        let results = graph.add_many("top", operator, &[&x, &count], kinds).unwrap();
        graph.output("values", &results[0], "", &[]).unwrap();
        graph.output("positions", &results[1], "", &[]).unwrap();
        let bytes = bytes_from_model(&model_from_graph(graph.finish("top")));
        let mut executor = Executor::open(&bytes, Compute::single()).unwrap();
        // Many equal values, zeros of both signs, infinities.
        let mut x: Vec<f32> = (0..2 * length).map(|_| random.uniform(-40.0, 40.0).round()).collect();
        (x[1], x[3], x[4]) = (-0.0, f32::INFINITY, f32::NEG_INFINITY);
        let got = outputs(&mut executor, &[2, length], &x);
        for (row, x) in x.chunks(length).enumerate() {
            let mut order: Vec<usize> = (0..length).collect();
            order.sort_by(|&a, &b| if largest == 1 { x[b].total_cmp(&x[a]) } else { x[a].total_cmp(&x[b]) });
            let wanted: Vec<f32> = order[..k].iter().map(|&i| i as f32).collect();
            assert_eq!(got[1][row * k..][..k], wanted, "{length} {k} {largest}");
            let values: Vec<f32> = order[..k].iter().map(|&i| x[i]).collect();
            assert_eq!(got[0][row * k..][..k], values);
        }
    }
}

#[test]
fn a_short_row_is_added_to_all_rows() {
    for (length, rows) in [(1, 700), (3, 7000), (20, 3), (63, 300), (65, 300)] {
        for is_first in [false, true] {
            let mut graph = Builder::default();
            let dims = vec![Some(rows), Some(length)];
            let x = graph.input("x", ElementType::Float, dims.clone(), &[]);
            let row: Vec<f32> = (0..length).map(|i| i as f32).collect();
            let row = constant(vec![1, length], &row);
            let inputs = if is_first { [&row, &x] } else { [&x, &row] };
            let y = graph.add("y", Operator::new("Sub"), &inputs, ElementType::Float, dims).unwrap();
            graph.output("y", &y, "", &[]).unwrap();
            let bytes = bytes_from_model(&model_from_graph(graph.finish("rows")));
            let mut executor = Executor::open(&bytes, Compute::single()).unwrap();
            let x: Vec<f32> = (0..rows * length).map(|i| i as f32).collect();
            let got = outputs(&mut executor, &[rows, length], &x);
            let sign = if is_first { -1.0 } else { 1.0 };
            let wanted: Vec<f32> = (0..rows * length).map(|i| sign * (i - i % length) as f32).collect();
            assert_eq!(got, [wanted], "{length} {rows}");
        }
    }
}

/// The values are those of `torch.nn.functional.interpolate` with `mode="linear"` and `"nearest"`.
#[test]
fn a_sequence_is_resized_along_its_length() {
    let x = [0.0, 1.0, 4.0, 9.0, -2.0, 0.0, 2.0, 8.0];
    let resized = |mode: &str, size: i64, scale: Option<f32>| {
        let mut graph = Builder::default();
        let dims = vec![Some(1), Some(2), Some(4)];
        let input = graph.input("x", ElementType::Float, dims, &[]);
        let none = constant(vec![0], &[]);
        let shape = vec![Some(1), Some(2), Some(size as usize)];
        let place = if mode == "nearest" { "asymmetric" } else { "half_pixel" };
        let resize = Operator::new("Resize").text("mode", mode).text("nearest_mode", "floor");
        let resize = resize.text("coordinate_transformation_mode", place);
        let y = match scale {
            Some(scale) => {
                let scales = constant(vec![3], &[1.0, 1.0, scale]);
                graph.add("y", resize, &[&input, &none, &scales], ElementType::Float, shape)
            }
            None => {
                let sizes = GraphTensor::ints([1, 2, size]);
                graph.add("y", resize, &[&input, &none, &none, &sizes], ElementType::Float, shape)
            }
        };
        graph.output("y", &y.unwrap(), "", &[]).unwrap();
        let model = bytes_from_model(&model_from_graph(graph.finish("resize")));
        let mut executor = Executor::open(&model, Compute::single()).unwrap();
        outputs(&mut executor, &[1, 2, 4], &x).remove(0)
    };
    assert_eq!(resized("linear", 4, None), x);
    let longer = [0.0, 0.5, 1.5, 3.5, 6.5, 9.0, -2.0, -1.0, 1.0 / 3.0, 5.0 / 3.0, 5.0, 8.0];
    let close = |found: &[f32], wanted: &[f32]| {
        found.len() == wanted.len()
            && found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-5)
    };
    assert!(close(&resized("linear", 6, None), &longer));
    assert!(close(&resized("linear", 2, Some(0.5)), &[0.5, 6.5, -1.0, 5.0]));
    let doubled = [0.0, 0.0, 1.0, 1.0, 4.0, 4.0, 9.0, 9.0, -2.0, -2.0, 0.0, 0.0, 2.0, 2.0, 8.0, 8.0];
    assert_eq!(resized("nearest", 8, Some(2.0)), doubled);
}
