//! Operators on images whose channels lie side by side: reshapes of them, parts of a batch, products and sums along the width.

use opendr_executor::{Data, Executor, Tensor};
use opendr_kernels::Compute;
use opendr_onnx::proto::{GraphProto, NodeProto};

use crate::graphs::{F32, bytes, floats, graph, ints, node, run, value, with_int};

const SHAPE: [usize; 4] = [3, 16, 2, 5];

/// Returns the elements of the input.
fn x() -> Vec<f32> {
    (0..SHAPE.iter().product()).map(|i| (i * 37 % 101) as f32 - 50.0).collect()
}

/// Returns a graph on `images`, which a convolution has copied from the input with the channels last.
fn on_images(nodes: Vec<NodeProto>, outputs: &[(&str, &[i64])]) -> GraphProto {
    let identity: Vec<f32> = (0..256).map(|i| if i % 17 == 0 { 1.0 } else { 0.0 }).collect();
    let mut all = vec![node("Conv", &["x", "identity"], &["images"])];
    all.extend(nodes);
    let outputs: Vec<_> = outputs.iter().map(|(name, dims)| value(name, F32, dims)).collect();
    let constants = [
        floats("identity", &[16, 16, 1, 1], &identity),
        floats("matrix", &[5, 4], &(0..20).map(|i| (i % 7) as f32 - 3.0).collect::<Vec<_>>()),
        ints("rows", &[2], &[96, 5]),
        ints("narrow", &[4], &[3, 16, 2, 4]),
        ints("sequence", &[3], &[1, 3, 160]),
        ints("planes", &[3], &[3, 16, 10]),
        ints("shape", &[4], &SHAPE.map(|dim| dim as i64)),
        ints("0", &[1], &[0]),
        ints("1", &[1], &[1]),
        ints("2", &[1], &[2]),
        ints("3", &[1], &[3]),
    ];
    graph(&all, &[value("x", F32, &SHAPE.map(|dim| dim as i64))], &outputs, &constants)
}

/// Shape and elements of an output.
type Output = (Vec<usize>, Vec<f64>);

/// Returns the outputs of a graph, which are the same with two threads, and the operators of its steps.
fn outputs(graph: GraphProto) -> (Vec<Output>, Vec<String>) {
    let (bytes, x) = (bytes(graph), x());
    let mut executor = Executor::open(&bytes, Compute::single()).unwrap();
    let outputs = run(&mut executor, &[(&SHAPE, Data::F32(&x))]).unwrap();
    let mut parallel = Executor::open(&bytes, Compute::with_threads(2)).unwrap();
    assert_eq!(run(&mut parallel, &[(&SHAPE, Data::F32(&x))]).unwrap(), outputs);
    let input = [Tensor { shape: &SHAPE, data: Data::F32(&x) }];
    let steps = executor.profile(&input, &mut |_| Ok(())).unwrap();
    (outputs, steps.into_iter().map(|step| step.operator).collect())
}

#[test]
fn a_batch_is_delayed_without_copies_of_its_reshapes() {
    let nodes = vec![
        node("Reshape", &["images", "sequence"], &["line"]),
        node("Slice", &["line", "0", "1", "1"], &["first"]),
        node("Slice", &["line", "0", "2", "1"], &["others"]),
        with_int(node("Concat", &["first", "others"], &["late"]), "axis", 1),
        node("Reshape", &["late", "shape"], &["delayed"]),
        node("Add", &["images", "delayed"], &["y"]),
    ];
    let (outputs, steps) = outputs(on_images(nodes, &[("y", &[3, 16, 2, 5])]));
    let (x, image) = (x(), 160);
    let wanted = (0..480).map(|i| f64::from(x[i] + x[if i < image { i } else { i - image }]));
    assert_eq!(outputs, [(SHAPE.to_vec(), wanted.collect())]);
    assert!(!steps.iter().any(|step| step == "Reshape" || step == "Slice"), "{steps:?}");
}

#[test]
fn a_reshape_that_is_an_output_has_the_order_of_its_shape() {
    let nodes = vec![
        node("Reshape", &["images", "sequence"], &["line"]),
        node("Slice", &["line", "1", "3", "1"], &["part"]),
        node("Reshape", &["images", "planes"], &["planes of images"]),
        with_int(node("ReduceMean", &["planes of images", "2"], &["means"]), "keepdims", 1),
        with_int(node("ReduceSum", &["images", "3"], &["sums"]), "keepdims", 0),
    ];
    let declared: [(&str, &[i64]); 5] = [
        ("line", &[1, 3, 160]),
        ("part", &[1, 2, 160]),
        ("planes of images", &[3, 16, 10]),
        ("means", &[3, 16, 1]),
        ("sums", &[3, 16, 2]),
    ];
    let (outputs, _) = outputs(on_images(nodes, &declared));
    let x: Vec<f64> = x().into_iter().map(f64::from).collect();
    assert_eq!(outputs[0], (vec![1, 3, 160], x.clone()));
    assert_eq!(outputs[1], (vec![1, 2, 160], x[160..].to_vec()));
    assert_eq!(outputs[2], (vec![3, 16, 10], x.clone()));
    assert_eq!((&outputs[3].0, &outputs[4].0), (&vec![3, 16, 1], &vec![3, 16, 2]));
    for (mean, plane) in outputs[3].1.iter().zip(x.chunks(10)) {
        assert!((mean - plane.iter().sum::<f64>() / 10.0).abs() < 1e-4);
    }
    let sums: Vec<f64> = x.chunks(5).map(|row| row.iter().sum()).collect();
    assert_eq!(outputs[4].1, sums);
}

#[test]
fn rows_are_multiplied_where_they_lie() {
    let nodes = vec![
        node("Reshape", &["images", "rows"], &["all rows"]),
        node("MatMul", &["all rows", "matrix"], &["product"]),
        node("Reshape", &["product", "narrow"], &["y"]),
        node("MatMul", &["images", "matrix"], &["z"]),
    ];
    let declared: [(&str, &[i64]); 3] = [("y", &[3, 16, 2, 4]), ("z", &[3, 16, 2, 4]), ("product", &[96, 4])];
    let (outputs, _) = outputs(on_images(nodes, &declared));
    let matrix: Vec<f64> = (0..20).map(|i| f64::from(i % 7) - 3.0).collect();
    let x = x();
    let product = |row: &[f32]| {
        (0..4)
            .map(|column| row.iter().enumerate().map(|(i, x)| f64::from(*x) * matrix[4 * i + column]).sum())
            .collect::<Vec<f64>>()
    };
    let wanted: Vec<f64> = x.chunks(5).flat_map(product).collect();
    assert_eq!(outputs[0], (vec![3, 16, 2, 4], wanted.clone()));
    assert_eq!(outputs[1], outputs[0]);
    assert_eq!(outputs[2], (vec![96, 4], wanted));
}

#[test]
fn a_depthwise_convolution_and_the_next_are_one_step_where_nothing_else_reads_between() {
    let side = 64;
    let taps: Vec<f32> = (0..144).map(|i| (i % 5) as f32 - 2.0).collect();
    let weights: Vec<f32> = (0..128).map(|i| (i % 3) as f32 - 1.0).collect();
    let model = |outputs: &[&str]| {
        let mut depthwise = with_int(node("Conv", &["x", "taps"], &["between"]), "group", 16);
        depthwise.attribute.push(opendr_onnx::proto::AttributeProto {
            name: "pads".to_owned(),
            ints: vec![1; 4],
            ..Default::default()
        });
        let nodes =
            [depthwise, node("Relu", &["between"], &["positive"]), node("Conv", &["positive", "w"], &["y"])];
        let declared = |name: &&str| value(name, F32, &[1, if *name == "y" { 8 } else { 16 }, side, side]);
        let outputs: Vec<_> = outputs.iter().map(declared).collect();
        let constants = [floats("taps", &[16, 1, 3, 3], &taps), floats("w", &[8, 16, 1, 1], &weights)];
        bytes(graph(&nodes, &[value("x", F32, &[1, 16, side, side])], &outputs, &constants))
    };
    let x: Vec<f32> = (0..16 * side * side).map(|i| (i * 29 % 23) as f32 - 11.0).collect();
    let shape = [1, 16, side as usize, side as usize];
    let run_with = |outputs: &[&str], threads: usize| {
        let mut executor = Executor::open(&model(outputs), Compute::with_threads(threads)).unwrap();
        let y = run(&mut executor, &[(&shape, Data::F32(&x))]).unwrap();
        let steps =
            executor.profile(&[Tensor { shape: &shape, data: Data::F32(&x) }], &mut |_| Ok(())).unwrap();
        (y, steps.iter().filter(|step| step.cost.float_operations > 0).count())
    };
    let (joined, steps) = run_with(&["y"], 1);
    let (apart, other_steps) = run_with(&["y", "positive"], 1);
    assert_eq!((steps, other_steps), (1, 2));
    assert_eq!(joined[0], apart[0]);
    assert_eq!(run_with(&["y"], 2).0, joined);
    // A pixel within the image.
    let at = |channel: usize, row: usize, column: usize| f64::from(x[(channel * 64 + row) * 64 + column]);
    let sum = |channel: usize| -> f64 {
        (0..9).map(|tap| f64::from(taps[channel * 9 + tap]) * at(channel, 10 + tap / 3, 20 + tap % 3)).sum()
    };
    let wanted: f64 =
        (0..16).map(|channel| f64::from(weights[3 * 16 + channel]) * sum(channel).max(0.0)).sum();
    assert_eq!(joined[0].1[(3 * 64 + 11) * 64 + 21], wanted);
}

#[test]
fn parts_of_a_concatenation_are_written_in_place_where_nothing_else_reads_them() {
    let side = 64_i64;
    let taps: Vec<f32> = (0..144).map(|i| (i % 5) as f32 - 2.0).collect();
    let weights: Vec<f32> = (0..128).map(|i| (i % 3) as f32 - 1.0).collect();
    let depthwise = |from: &str, to: &str| {
        let mut node = with_int(node("Conv", &[from, "taps"], &[to]), "group", 16);
        node.attribute.push(opendr_onnx::proto::AttributeProto {
            name: "pads".to_owned(),
            ints: vec![1; 4],
            ..Default::default()
        });
        node
    };
    let model = |outputs: &[&str]| {
        let nodes = [
            depthwise("x", "first"),
            node("Conv", &["x", "w"], &["product"]),
            node("Sigmoid", &["product"], &["second"]),
            node("Relu", &["x"], &["third"]),
            depthwise("third", "between"),
            node("Conv", &["between", "w"], &["fourth"]),
            with_int(node("Concat", &["first", "second", "third", "fourth"], &["y"]), "axis", 1),
        ];
        let declared = |name: &&str| {
            let channels = match *name {
                "y" => 48,
                "second" | "fourth" => 8,
                _ => 16,
            };
            value(name, F32, &[2, channels, side, side])
        };
        let outputs: Vec<_> = outputs.iter().map(declared).collect();
        let constants = [floats("taps", &[16, 1, 3, 3], &taps), floats("w", &[8, 16, 1, 1], &weights)];
        bytes(graph(&nodes, &[value("x", F32, &[2, 16, side, side])], &outputs, &constants))
    };
    let image = (side * side) as usize;
    let x: Vec<f32> = (0..2 * 16 * image).map(|i| (i * 29 % 23) as f32 - 11.0).collect();
    let shape = [2, 16, side as usize, side as usize];
    for threads in [1, 2] {
        let run_with = |outputs: &[&str]| {
            let mut executor = Executor::open(&model(outputs), Compute::with_threads(threads)).unwrap();
            let y = run(&mut executor, &[(&shape, Data::F32(&x))]).unwrap();
            let input = [Tensor { shape: &shape, data: Data::F32(&x) }];
            (y, executor.profile(&input, &mut |_| Ok(())).unwrap())
        };
        let (whole, steps) = run_with(&["y"]);
        let (parts, copying) = run_with(&["y", "first", "second", "third", "fourth"]);
        let copied = |steps: &[opendr_executor::LayerProfile]| {
            let concat = steps.iter().find(|step| step.operator == "Concat");
            concat.map_or(0, |step| step.tensor_bytes)
        };
        // Only the part that no convolution computes is copied.
        assert_eq!(copied(&steps), 2 * 4 * 2 * 16 * image as u64);
        assert_eq!(copied(&copying), 2 * 4 * 2 * 48 * image as u64);
        assert_eq!(whole[0], parts[0]);
        let joined = |at: usize| {
            parts[1..].iter().flat_map(move |(shape, part)| {
                let length = shape[1] * image;
                part[at * length..(at + 1) * length].iter().copied()
            })
        };
        assert!(joined(0).chain(joined(1)).eq(whole[0].1.iter().copied()));
    }
}
