//! Recognition of the conventions of exported detectors, on networks whose outputs are constants with one object.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::PathBuf;

use opendr_detection::object_detection_2d::{
    BoxFormat, BoxUnit, ImportedDetector, ImportedDetectorParams, Objectness, OutputLayout, ScoreFormat,
};
use opendr_engine::data::Image;
use opendr_engine::learner::Handle;
use opendr_engine::target::Name;
use opendr_engine::{Device, ErrorKind, Result};
use opendr_onnx::{
    Array, Builder, Data, ElementType, GraphTensor, Operator, bytes_from_model, model_from_graph,
};
use opendr_perception_common::exported_network::{InputColour, InputLevels, InputParams, InputResize};

/// Corners of the object in an image of 64 x 64 pixels; its class is 1 and its score 0.9.
const CORNERS: [f32; 4] = [16.0, 8.0, 48.0, 40.0];

type Output<'a> = (&'a str, &'a [usize], Data);

/// Operators between the constants and the outputs.
#[derive(Clone, Copy, PartialEq)]
enum Tail {
    Nothing,
    Sum,
    Exponential,
}

/// Writes a network to a file.
fn network(
    name: &str,
    inputs: &[(&str, ElementType, &[usize])],
    tail: Tail,
    outputs: Vec<Output<'_>>,
) -> PathBuf {
    let mut graph = Builder::default();
    let dims = |dims: &[usize]| dims.iter().copied().map(Some).collect::<Vec<_>>();
    let wires: Vec<_> =
        inputs.iter().map(|(name, kind, shape)| graph.input(name, *kind, dims(shape), &[])).collect();
    let axes = 0..inputs[0].2.len() as i64;
    let mean = Operator::new("ReduceMean").ints("axes", axes).int("keepdims", 0);
    let mean = graph.add("mean", mean, &[&wires[0]], ElementType::Float, vec![]).unwrap();
    let mut unary = |name, inputs: &[&GraphTensor]| {
        graph.add("zero", Operator::new(name), inputs, ElementType::Float, vec![]).unwrap()
    };
    let zero = match tail {
        Tail::Exponential => {
            let small = unary("Mul", &[&mean, &GraphTensor::scalar(1e-6)]);
            let power = unary("Exp", &[&small]);
            unary("Mul", &[&power, &GraphTensor::scalar(0.0)])
        }
        Tail::Nothing | Tail::Sum => unary("Mul", &[&mean, &GraphTensor::scalar(0.0)]),
    };
    for (name, shape, data) in outputs {
        let kind = data.kind();
        let mut wire = GraphTensor::constant(Array::new(shape.to_vec(), data).unwrap());
        if tail != Tail::Nothing && kind == ElementType::Float {
            wire = graph.add("sum", Operator::new("Add"), &[&wire, &zero], kind, dims(shape)).unwrap();
        }
        graph.output(name, &wire, "", &[]).unwrap();
    }
    let path = std::env::temp_dir().join(format!("opendr-{name}-{}.onnx", std::process::id()));
    std::fs::write(&path, bytes_from_model(&model_from_graph(graph.finish(name)))).unwrap();
    path
}

/// The image input of most networks.
const IMAGES: (&str, ElementType, &[usize]) = ("images", ElementType::Float, &[1, 3, 64, 64]);

/// Rows of `fields` values: `filler` everywhere, and `row` at `at`.
fn rows(count: usize, at: usize, row: &[f32], filler: f32) -> Data {
    let mut values = vec![filler; count * row.len()];
    values[at * row.len()..][..row.len()].copy_from_slice(row);
    Data::Float(values)
}

fn first(count: usize, value: f32) -> Data {
    rows(count, 0, &[value], 0.0)
}

fn class(count: usize) -> Data {
    Data::Int((0..count).map(|index| i64::from(index == 0)).collect())
}

fn load(path: &PathBuf, params: ImportedDetectorParams) -> Result<Handle<ImportedDetector>> {
    let mut detector = Handle::<ImportedDetector>::new(params, Device::Cpu)?;
    let loaded = detector.load(path);
    std::fs::remove_file(path).unwrap();
    loaded.map(|()| detector)
}

/// Checks that a network detects the object; returns what was recognised.
fn detects(path: PathBuf, params: ImportedDetectorParams) -> ImportedDetectorParams {
    let mut detector = load(&path, params).unwrap();
    let image = Image::from_rgb8(vec![90; 64 * 64 * 3], 64, 64).unwrap();
    let found = detector.infer(&image).unwrap().boxes;
    let [object] = &found[..] else { panic!("{}: {found:?}", path.display()) };
    let close = object.corners().iter().zip(CORNERS).all(|(found, wanted)| (found - wanted).abs() < 1e-3);
    assert!(close && (object.confidence - 0.9).abs() < 1e-3, "{}: {object:?}", path.display());
    assert_eq!(object.name, Name::Index(1), "{}", path.display());
    detector.params().clone()
}

fn with_levels(levels: InputLevels) -> ImportedDetectorParams {
    let input = InputParams { levels, ..InputParams::default() };
    ImportedDetectorParams { input, ..ImportedDetectorParams::default() }
}

fn recognised(path: PathBuf) -> ImportedDetectorParams {
    detects(path, ImportedDetectorParams::default())
}

const ROW: [f32; 8] = [32.0, 24.0, 32.0, 32.0, 0.9, 0.0, 1.0, 0.0];

#[test]
fn candidates_with_objectness() {
    let output = ("output", &[1, 252, 8][..], rows(252, 7, &ROW, 0.0));
    let params = recognised(network("yolov5", &[IMAGES], Tail::Nothing, vec![output]));
    assert_eq!((params.layout, params.objectness), (OutputLayout::Candidates, Objectness::Present));
    let output = ("outputs", &[1, 84, 8][..], rows(84, 7, &ROW, 0.0));
    let params = recognised(network("yolov6", &[IMAGES], Tail::Sum, vec![output]));
    assert_eq!((params.layout, params.input.levels), (OutputLayout::Candidates, InputLevels::Unit));
    let output = ("output", &[1, 84, 8][..], rows(84, 7, &ROW, 0.0));
    let params = recognised(network("yolox_decoded", &[IMAGES], Tail::Exponential, vec![output]));
    assert_eq!((params.layout, params.input.levels), (OutputLayout::Candidates, InputLevels::Bytes));
}

#[test]
fn candidates_without_objectness() {
    let mut values = vec![0.0; 7 * 84];
    for (field, value) in [32.0, 24.0, 32.0, 32.0, 0.0, 0.9, 0.0].into_iter().enumerate() {
        values[field * 84 + 9] = value;
    }
    let output = ("output0", &[1, 7, 84][..], Data::Float(values));
    let params = recognised(network("yolov8", &[IMAGES], Tail::Nothing, vec![output]));
    assert_eq!((params.layout, params.objectness), (OutputLayout::Candidates, Objectness::Absent));
}

#[test]
fn candidates_relative_to_cells() {
    let row = [1.0, 0.75, 0.0, 0.0, 0.9, 0.0, 1.0, 0.0];
    let output = ("output", &[1, 84, 8][..], rows(84, 80, &row, 0.0));
    let params = recognised(network("yolox", &[IMAGES], Tail::Nothing, vec![output]));
    let found = (params.layout, params.input.resize, params.input.colour);
    assert_eq!(found, (OutputLayout::GridCandidates, InputResize::TopLeftTruncated, InputColour::Bgr));
}

#[test]
fn rows_of_detections() {
    let row = [16.0, 8.0, 48.0, 40.0, 0.9, 1.0];
    let output = ("output0", &[1, 50, 6][..], rows(50, 0, &row, 0.0));
    let params = recognised(network("yolov10", &[IMAGES], Tail::Nothing, vec![output]));
    assert_eq!((params.layout, params.input.resize), (OutputLayout::Detections, InputResize::Letterbox));
    let row = [0.0, 16.0, 8.0, 48.0, 40.0, 1.0, 0.9];
    recognised(network("yolov7", &[IMAGES], Tail::Nothing, vec![("output", &[2, 7], rows(2, 0, &row, 0.0))]));
    let nhwc = ("images", ElementType::Float, &[1, 64, 64, 3][..]);
    let row = [0.0, 8.0, 16.0, 40.0, 48.0, 0.9, 2.0];
    let output = ("detections", &[1, 10, 7][..], rows(10, 0, &row, 0.0));
    let params = with_levels(InputLevels::Bytes);
    let params = detects(network("efficientdet", &[nhwc], Tail::Nothing, vec![output]), params);
    assert_eq!((params.boxes, params.first_class), (BoxFormat::Yxyx, Some(1)));
}

#[test]
fn lists_of_detections() {
    let boxes = || rows(10, 0, &CORNERS, 0.0);
    let outputs = vec![
        ("num_dets", &[1, 1][..], Data::Int(vec![1])),
        ("det_boxes", &[1, 10, 4], boxes()),
        ("det_scores", &[1, 10], first(10, 0.9)),
        ("det_classes", &[1, 10], class(10)),
    ];
    recognised(network("nms", &[IMAGES], Tail::Nothing, outputs));
    let sizes = ("orig_target_sizes", ElementType::Int, &[1, 2][..]);
    let outputs = vec![
        ("labels", &[1, 10][..], class(10)),
        ("boxes", &[1, 10, 4], boxes()),
        ("scores", &[1, 10], first(10, 0.9)),
    ];
    let params = recognised(network("d_fine", &[IMAGES, sizes], Tail::Nothing, outputs));
    assert_eq!(params.input.resize, InputResize::Stretch);
    let nhwc = ("images", ElementType::Float, &[1, 64, 64, 3][..]);
    let fractions = [0.125, 0.25, 0.625, 0.75];
    let outputs = vec![
        ("detection_boxes", &[1, 10, 4][..], rows(10, 0, &fractions, 0.0)),
        ("detection_scores", &[1, 10], first(10, 0.9)),
        ("detection_classes", &[1, 10], first(10, 2.0)),
        ("num_detections", &[1], Data::Float(vec![1.0])),
    ];
    let params = with_levels(InputLevels::Bytes);
    detects(network("tensorflow", &[nhwc], Tail::Nothing, outputs), params);
}

#[test]
fn queries() {
    let logits = rows(10, 0, &[-9.0, 2.197_225, -9.0], -9.0);
    let boxes = rows(10, 0, &[0.5, 0.375, 0.5, 0.5], 0.5);
    let outputs = vec![("dets", &[1, 10, 4][..], boxes), ("labels", &[1, 10, 3], logits)];
    let params = recognised(network("rf_detr", &[IMAGES], Tail::Nothing, outputs));
    assert_eq!((params.layout, params.input.levels), (OutputLayout::Queries, InputLevels::ImageNet));
}

#[test]
fn what_tools_leave_open_is_to_be_given() {
    let outputs = || {
        let row = [16.0, 8.0, 48.0, 40.0, 0.9];
        vec![("dets", &[1, 10, 5][..], rows(10, 0, &row, 0.0)), ("labels", &[1, 10], class(10))]
    };
    let path = network("mmdeploy", &[IMAGES], Tail::Nothing, outputs());
    let error = load(&path, ImportedDetectorParams::default()).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    assert!(format!("{error:#}").contains("set colour, levels"), "{error:#}");
    let params = ImportedDetectorParams {
        input: InputParams {
            colour: InputColour::Bgr,
            levels: InputLevels::ImageNet,
            ..InputParams::default()
        },
        ..ImportedDetectorParams::default()
    };
    detects(network("mmdeploy", &[IMAGES], Tail::Nothing, outputs()), params);

    let inputs = [
        ("im_shape", ElementType::Float, &[1, 2][..]),
        ("image", ElementType::Float, &[1, 3, 64, 64]),
        ("scale_factor", ElementType::Float, &[1, 2]),
    ];
    let outputs = || {
        let row = [1.0, 0.9, 16.0, 8.0, 48.0, 40.0];
        vec![("boxes", &[2, 6][..], rows(2, 0, &row, 0.0)), ("count", &[1], Data::Int(vec![1]))]
    };
    let path = network("paddle", &inputs, Tail::Nothing, outputs());
    let error = load(&path, ImportedDetectorParams::default()).err().unwrap();
    assert!(format!("{error:#}").contains("set levels"), "{error:#}");
    let params = with_levels(InputLevels::Unit);
    detects(network("paddle", &inputs, Tail::Nothing, outputs()), params);
}

#[test]
fn a_layout_can_be_given() {
    let boxes = rows(84, 3, &CORNERS, 0.0);
    let scores = rows(84, 3, &[0.0, 0.9, 0.0], 0.0);
    let outputs = vec![("a", &[1, 84, 4][..], boxes), ("b", &[1, 84, 3], scores)];
    let params = ImportedDetectorParams {
        layout: OutputLayout::Candidates,
        boxes: BoxFormat::Xyxy,
        unit: BoxUnit::Pixels,
        scores: ScoreFormat::Probabilities,
        objectness: Objectness::Absent,
        input: InputParams {
            resize: InputResize::Stretch,
            colour: InputColour::Rgb,
            levels: InputLevels::Unit,
            ..InputParams::default()
        },
        ..ImportedDetectorParams::default()
    };
    detects(network("split", &[IMAGES], Tail::Nothing, outputs), params);
}

#[test]
fn others_are_refused() {
    let map = ("map", &[1, 8, 4, 4][..], Data::Float(vec![0.0; 128]));
    let path = network("maps", &[IMAGES], Tail::Nothing, vec![map]);
    let error = load(&path, ImportedDetectorParams::default()).err().unwrap();
    let text = format!("{error:#}");
    assert!(text.contains("set layout, boxes") && text.contains("map: f32[1, 8, 4, 4]"), "{text}");
    let wrong = ("image", ElementType::Float, &[1, 4, 64, 64][..]);
    let path =
        network("channels", &[wrong], Tail::Nothing, vec![("rows", &[1, 84, 8], rows(84, 0, &ROW, 0.0))]);
    let error = load(&path, ImportedDetectorParams::default()).err().unwrap();
    assert!(format!("{error:#}").contains("no input of the network is an image"), "{error:#}");
}
