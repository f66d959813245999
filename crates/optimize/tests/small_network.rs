//! A small network with every kind of quantised node, on both runtimes.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::PathBuf;

use opendr_engine::model::{Manifest, Model, ModelWriter};
use opendr_engine::{Device, ErrorKind, Random, Silent};
use opendr_inference::recording::{self, Recording};
use opendr_inference::{Session, TensorView, runtimes};
use opendr_onnx::{
    Array, Builder, Data, ElementType, GraphTensor, Operator, bytes_from_model, model_from_bytes,
    model_from_graph,
};
use opendr_optimize::{Calibration, MetricValue, OptimizeOptions, Precision, optimize};

const INPUT: [usize; 4] = [1, 3, 16, 16];

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("opendr-optimize-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        fs::remove_dir_all(&self.0).ok();
    }
}

fn weights(random: &mut Random, dims: &[usize]) -> GraphTensor {
    let count = dims.iter().product();
    let fan_in: usize = dims[1..].iter().product();
    let scale = (2.0 / fan_in as f32).sqrt();
    let floats = (0..count).map(|_| random.normal() as f32 * scale).collect();
    GraphTensor::constant(Array::new(dims.to_vec(), Data::Float(floats)).unwrap())
}

/// A network of convolutions (one depthwise), a rectifier, a leaky one, pooling, a sum, a concatenation, a resize and
/// a matrix product.
fn network() -> Vec<u8> {
    let mut random = Random::new(3);
    let mut graph = Builder::default();
    let dims = |dims: &[usize]| dims.iter().copied().map(Some).collect::<Vec<_>>();
    graph.reserve("scores");
    graph.reserve("map");
    let image = graph.input("image", ElementType::Float, dims(&INPUT), &[]);
    let mut conv = |graph: &mut Builder, input: &GraphTensor, filters: usize, side: usize, groups: usize| {
        let channels = input.dims()[1].unwrap();
        let kernel = weights(&mut random, &[filters, channels / groups, side, side]);
        let bias =
            weights(&mut random, &[filters, 1]).array().unwrap().clone().reshaped(vec![filters]).unwrap();
        let pad = (side / 2) as i64;
        let operator = Operator::new("Conv")
            .ints("kernel_shape", [side as i64; 2])
            .ints("pads", [pad; 4])
            .ints("strides", [1, 1])
            .int("group", groups as i64);
        let mut shape = input.dims().to_vec();
        shape[1] = Some(filters);
        graph
            .add("conv", operator, &[input, &kernel, &GraphTensor::constant(bias)], ElementType::Float, shape)
            .unwrap()
    };
    let plain = |graph: &mut Builder, operator: Operator, inputs: &[&GraphTensor], shape: &[usize]| {
        graph.add("node", operator, inputs, ElementType::Float, dims(shape)).unwrap()
    };
    let first = conv(&mut graph, &image, 16, 3, 1);
    let first = plain(&mut graph, Operator::new("Relu"), &[&first], &[1, 16, 16, 16]);
    let pool = Operator::new("MaxPool").ints("kernel_shape", [2, 2]).ints("strides", [2, 2]);
    let pooled = plain(&mut graph, pool, &[&first], &[1, 16, 8, 8]);
    let second = conv(&mut graph, &pooled, 16, 3, 16);
    let second =
        plain(&mut graph, Operator::new("LeakyRelu").float("alpha", 0.1), &[&second], &[1, 16, 8, 8]);
    let sum = plain(&mut graph, Operator::new("Add"), &[&second, &pooled], &[1, 16, 8, 8]);
    let joined = plain(&mut graph, Operator::new("Concat").int("axis", 1), &[&sum, &second], &[1, 32, 8, 8]);
    let scales = GraphTensor::constant(Array::new(vec![4], Data::Float(vec![1.0, 1.0, 2.0, 2.0])).unwrap());
    let resize = Operator::new("Resize")
        .text("mode", "nearest")
        .text("coordinate_transformation_mode", "asymmetric")
        .text("nearest_mode", "floor");
    let larger = plain(&mut graph, resize, &[&joined, &GraphTensor::absent(), &scales], &[1, 32, 16, 16]);
    let map = conv(&mut graph, &larger, 8, 1, 1);
    graph.output("map", &map, "", &[]).unwrap();
    let mean = plain(&mut graph, Operator::new("GlobalAveragePool"), &[&joined], &[1, 32, 1, 1]);
    let flat = plain(&mut graph, Operator::new("Flatten"), &[&mean], &[1, 32]);
    let kernel = weights(&mut Random::new(9), &[10, 32]);
    let bias = GraphTensor::constant(Array::new(vec![10], Data::Float(vec![0.1; 10])).unwrap());
    let gemm = Operator::new("Gemm").int("transB", 1);
    let scores = plain(&mut graph, gemm, &[&flat, &kernel, &bias], &[1, 10]);
    graph.output("scores", &scores, "", &[]).unwrap();
    bytes_from_model(&model_from_graph(graph.finish("small")))
}

fn container(folder: &Folder) -> Model {
    let mut writer = ModelWriter::new(folder.0.join("model"), Manifest::new("", "")).unwrap();
    writer.add("model.onnx", &network()).unwrap();
    writer.add("notes.txt", b"kept").unwrap();
    writer.finish().unwrap()
}

fn picture(random: &mut Random) -> Vec<f32> {
    (0..INPUT.iter().product()).map(|_| random.normal() as f32).collect()
}

fn recordings(model: &Model, count: usize) -> Vec<Recording> {
    let session = Session::open(&model.onnx().unwrap(), Device::Cpu).unwrap();
    let mut random = Random::new(1);
    recording::start();
    for _ in 0..count {
        let picture = picture(&mut random);
        session.run(&[TensorView::new(&INPUT, &picture).unwrap()], |_| Ok(())).unwrap();
    }
    recording::take()
}

/// Returns the signal-to-noise ratio in decibels of each output of `model` against `reference`, on each runtime.
fn ratios(reference: &Model, model: &Model) -> Vec<f64> {
    let mut ratios = Vec::new();
    for runtime in runtimes() {
        let mut random = Random::new(2);
        let open =
            |model: &Model| Session::open_with(&*runtime, &model.onnx().unwrap(), Device::Cpu).unwrap();
        let (reference, session) = (open(reference), open(model));
        let mut powers = vec![[0.0; 2]; reference.outputs().len()];
        for _ in 0..4 {
            let picture = picture(&mut random);
            let input = TensorView::new(&INPUT, &picture).unwrap();
            let mut wanted: Vec<Vec<f32>> = Vec::new();
            reference
                .run(&[input], |outputs| {
                    wanted.extend(outputs.iter().map(|output| output.values().unwrap().to_vec()));
                    Ok(())
                })
                .unwrap();
            session
                .run(&[input], |outputs| {
                    for ((output, wanted), [power, lost]) in outputs.iter().zip(&wanted).zip(&mut powers) {
                        for (value, wanted) in output.values::<f32>().unwrap().iter().zip(wanted) {
                            *power += f64::from(*wanted).powi(2);
                            *lost += f64::from(value - wanted).powi(2);
                        }
                    }
                    Ok(())
                })
                .unwrap();
        }
        ratios.extend(powers.iter().map(|[power, lost]| 10.0 * (power / lost).log10()));
    }
    ratios
}

fn options(precision: Precision) -> OptimizeOptions {
    OptimizeOptions { precision, ..OptimizeOptions::default() }
}

#[test]
fn int8_predicts_nearly_the_same_on_every_runtime() {
    let folder = Folder::new("int8");
    let model = container(&folder);
    let seen = recordings(&model, 16);
    for calibration in
        [Calibration::LeastSquares, Calibration::MinMax, Calibration::Percentile, Calibration::Entropy]
    {
        let output = folder.0.join(calibration.name());
        let options = OptimizeOptions { calibration, ..options(Precision::Int8) };
        let report = optimize(&model, &options, &seen, None, Device::Cpu, &output, &Silent).unwrap();
        let written = Model::open(&output).unwrap();
        assert_eq!(written.file("notes.txt").unwrap(), b"kept");
        assert!(written.manifest().lineage.importer.contains("int8"));
        let ratios = ratios(&model, &written);
        assert!(ratios.iter().all(|ratio| *ratio > 22.0), "{calibration:?}: {ratios:?}\n{report}");
        assert_eq!(
            report.layers.iter().map(|layer| layer.op.as_str()).collect::<Vec<_>>(),
            ["Conv", "Conv", "Conv", "Gemm"]
        );
        assert!(
            report.layers.iter().all(|layer| layer.output_snr_db > 22.0 && layer.weight_snr_db > 30.0),
            "{report}"
        );
    }
}

#[test]
fn layers_by_name_stay_in_floats() {
    let folder = Folder::new("keep");
    let model = container(&folder);
    let seen = recordings(&model, 4);
    let run = |keep_float: Vec<String>| {
        let options = OptimizeOptions { keep_float, ..options(Precision::Int8) };
        optimize(&model, &options, &seen, None, Device::Cpu, &folder.0.join("out"), &Silent)
    };
    let all: Vec<String> = run(Vec::new()).unwrap().layers.into_iter().map(|layer| layer.name).collect();
    let report = run(vec![all[1].clone()]).unwrap();
    assert_eq!(
        report.layers.iter().map(|layer| layer.is_float).collect::<Vec<_>>(),
        [false, true, false, false]
    );
    run(all).unwrap();
    let written = Model::open(folder.0.join("out")).unwrap();
    assert!(ratios(&model, &written).iter().all(|ratio| *ratio > 100.0), "all layers are in floats");
    assert_eq!(run(vec!["nothing".to_owned()]).unwrap_err().kind(), ErrorKind::InvalidParam);
}

#[test]
fn layers_go_back_to_floats_until_the_drop_is_small_enough() {
    let folder = Folder::new("drop");
    let model = container(&folder);
    let seen = recordings(&model, 4);
    let options = OptimizeOptions { max_drop: Some(0.5), ..options(Precision::Int8) };
    let mut sizes = Vec::new();
    // The number of quantised layers serves as the loss: it is small enough once half of the layers are in floats
    // again.
    let mut judge = |judged: &Model| {
        let network = model_from_bytes(&judged.onnx()?)?.graph.unwrap_or_default();
        let rounded = network.node.iter().filter(|node| node.name.ends_with("weights/rounded")).count();
        sizes.push(rounded);
        let value = 1.0 - rounded as f64 / 4.0;
        Ok(MetricValue { name: "points".to_owned(), value, is_error: false })
    };
    let output = folder.0.join("out");
    let report = optimize(&model, &options, &seen, Some(&mut judge), Device::Cpu, &output, &Silent).unwrap();
    assert_eq!(sizes, [0, 4, 3, 2]);
    let accuracy = report.accuracy.unwrap();
    assert_eq!((accuracy.metric.as_str(), accuracy.before, accuracy.after), ("points", 1.0, 0.5));
    let worst_first = report.layers.iter().filter(|layer| layer.is_float).map(|layer| layer.layer_snr_db());
    let others = report.layers.iter().filter(|layer| !layer.is_float).map(|layer| layer.layer_snr_db());
    assert!(worst_first.fold(0.0, f64::max) <= others.fold(f64::INFINITY, f64::min));
    let unmeasured = optimize(&model, &options, &seen, None, Device::Cpu, &output, &Silent);
    assert_eq!(unmeasured.unwrap_err().kind(), ErrorKind::InvalidParam);
}

#[test]
fn fp16_predicts_the_same_on_every_runtime() {
    let folder = Folder::new("fp16");
    let model = container(&folder);
    let output = folder.0.join("out");
    let report =
        optimize(&model, &options(Precision::Fp16), &[], None, Device::Cpu, &output, &Silent).unwrap();
    assert!(report.bytes[1] < report.bytes[0], "{report}");
    let ratios = ratios(&model, &Model::open(&output).unwrap());
    assert!(ratios.iter().all(|ratio| *ratio > 60.0), "{ratios:?}");
}

#[test]
fn unsupported_cases_are_errors() {
    let folder = Folder::new("report");
    let model = container(&folder);
    let output = folder.0.join("out");
    let run = |model: &Model, seen: &[Recording]| {
        let options = options(Precision::Int8);
        optimize(model, &options, seen, None, Device::Cpu, &output, &Silent).unwrap_err()
    };
    let unseen = run(&model, &[]);
    assert_eq!(unseen.kind(), ErrorKind::InvalidInput);
    assert!(unseen.to_string().contains("pass a data set"), "{unseen}");
    let mut old = model_from_bytes(&model.onnx().unwrap()).unwrap();
    old.opset_import[0].version = 12;
    let mut writer = ModelWriter::new(folder.0.join("old"), Manifest::new("", "")).unwrap();
    writer.add("model.onnx", &bytes_from_model(&old)).unwrap();
    let old = writer.finish().unwrap();
    assert_eq!(run(&old, &recordings(&model, 1)).kind(), ErrorKind::Unsupported);
    let mut writer = ModelWriter::new(folder.0.join("none"), Manifest::new("", "")).unwrap();
    writer.add("weights.bin", b"").unwrap();
    assert_eq!(run(&writer.finish().unwrap(), &[]).kind(), ErrorKind::Unsupported);
    assert!(!output.exists(), "nothing is written");
}
