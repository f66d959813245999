//! Depth estimators that other packages exported, beside the packages' own predictions.
//!
//! `tests/extended/exported_network_fixtures.py` writes the fixtures: small networks with random weights.

#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use opendr_depth::depth_estimation::{
    DepthKind, ImportedDepthEstimator, ImportedDepthEstimatorParams, MapInterpolation,
};
use opendr_engine::data::Image;
use opendr_engine::learner::Handle;
use opendr_engine::params::ParamValue;
use opendr_engine::target::HeatmapValues;
use opendr_engine::{Device, ErrorKind, Result};
use opendr_onnx::{Builder, ElementType, Operator, bytes_from_model, model_from_graph};
use opendr_perception_common::exported_network::{
    InputColour, InputLevels, InputParams, InputResize, NetworkKind,
};
use opendr_perception_testing::fixture_image::fixture_image;
use opendr_perception_testing::learner_checks::check_trained_learner;

/// Names of the fixtures.
const FIXTURES: [&str; 7] =
    ["dpt", "dpt_dynamo", "depth_anything", "depth_anything_metric", "glpn", "zoe_depth", "yolo_depth"];

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/imported").join(name)
}

fn load(path: PathBuf, params: ImportedDepthEstimatorParams) -> Result<Handle<ImportedDepthEstimator>> {
    let mut estimator = Handle::<ImportedDepthEstimator>::new(params, Device::Cpu)?;
    estimator.load(path)?;
    Ok(estimator)
}

fn depths(estimator: &mut Handle<ImportedDepthEstimator>, image: &Image) -> (Vec<f32>, Vec<usize>) {
    let map = estimator.infer(image).unwrap();
    let HeatmapValues::Scores(depths) = map.values() else { return (Vec::new(), Vec::new()) };
    (depths.to_vec(), map.shape().to_vec())
}

#[test]
fn depths_are_those_of_the_packages() {
    for name in FIXTURES {
        let text = std::fs::read(fixture(&format!("{name}.json"))).unwrap();
        let expected: serde_json::Value = serde_json::from_slice(&text).unwrap();
        let rows = expected["depths"].as_array().unwrap().iter().map(|row| row.as_array().unwrap());
        let wanted: Vec<f64> = rows.flatten().map(|depth| depth.as_f64().unwrap()).collect();
        let [width, height] = [0, 1].map(|axis| expected["image"][axis].as_u64().unwrap() as usize);
        let input = InputParams {
            size: expected["size"].as_u64().map(|side| side as usize),
            ..InputParams::default()
        };
        let params = ImportedDepthEstimatorParams { input, ..ImportedDepthEstimatorParams::default() };
        let mut estimator = load(fixture(&format!("{name}.zip")), params).unwrap();
        assert_eq!(estimator.params().kind.name(), expected["kind"], "{name}");
        let alignment = (expected["kind"] != "metric").then(|| ParamValue::from("inverse_scale_shift"));
        assert_eq!(estimator.metric_params().remove("alignment"), alignment, "{name}");
        let (found, shape) = depths(&mut estimator, &fixture_image(width, height));
        assert_eq!(shape, [height, width], "{name}");
        let errors = found.iter().zip(&wanted).map(|(found, wanted)| (f64::from(*found) - wanted).abs());
        let error = errors.reduce(f64::max).unwrap();
        println!("{name}: largest error {error:.6}");
        assert!(error < 1e-3, "{name}: {error}");
    }
}

/// What a network that [`channel`] writes returns.
#[derive(Clone, Copy, PartialEq)]
enum Output {
    /// `[1, 1, height, width]`, with this name.
    Named(&'static str),
    /// `[1, height, width]`, without a name that means something.
    Squeezed,
}

/// Writes a network that returns the red channel of an image of `sides` (`None` if they are dynamic).
fn channel(name: &str, [height, width]: [Option<usize>; 2], output: Output) -> PathBuf {
    let mut graph = Builder::default();
    let image = graph.input("image", ElementType::Float, vec![Some(1), Some(3), height, width], &[]);
    let reduce = |keep: i64| Operator::new("ReduceMax").ints("axes", [1]).int("keepdims", keep);
    let (operator, shape, name_of_output) = match output {
        Output::Named(name) => (reduce(1), vec![Some(1), Some(1), height, width], name),
        Output::Squeezed => (reduce(0), vec![Some(1), height, width], "42"),
    };
    let red = graph.add("red", operator, &[&image], ElementType::Float, shape).unwrap();
    graph.output(name_of_output, &red, "", &[]).unwrap();
    let folder = std::env::temp_dir().join(format!("opendr-depth-estimator-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("{name}.onnx"));
    std::fs::write(&path, bytes_from_model(&model_from_graph(graph.finish(name)))).unwrap();
    path
}

const FIXED: [Option<usize>; 2] = [Some(8), Some(12)];

fn metric() -> ImportedDepthEstimatorParams {
    let input = InputParams {
        resize: InputResize::Stretch,
        colour: InputColour::Rgb,
        levels: InputLevels::Bytes,
        ..InputParams::default()
    };
    ImportedDepthEstimatorParams { kind: DepthKind::Metric, input, ..ImportedDepthEstimatorParams::default() }
}

/// Returns an image of one level.
fn grey(level: u8, width: usize, height: usize) -> Image {
    Image::from_rgb8(vec![level; width * height * 3], width, height).unwrap()
}

#[test]
fn maps_have_the_size_of_the_image_or_of_the_network() {
    let path = channel("sizes", FIXED, Output::Named("depth"));
    let mut estimator = load(path.clone(), metric()).unwrap();
    let (found, shape) = depths(&mut estimator, &grey(200, 21, 13));
    assert_eq!(shape, [13, 21]);
    assert!(found.iter().all(|depth| (depth - 200.0).abs() < 1e-3), "{found:?}");
    let mut coarse = load(path, ImportedDepthEstimatorParams { full_size: false, ..metric() }).unwrap();
    assert_eq!(depths(&mut coarse, &grey(200, 21, 13)).1, [8, 12]);
}

#[test]
fn metric_depths_have_a_scale() {
    for full_size in [true, false] {
        let params = ImportedDepthEstimatorParams { scale: 0.01, full_size, ..metric() };
        let mut estimator = load(channel("scale", FIXED, Output::Named("depth")), params).unwrap();
        let (found, _) = depths(&mut estimator, &grey(200, 12, 8));
        assert!(found.iter().all(|depth| (depth - 2.0).abs() < 1e-5), "{found:?}");
    }
    let params = ImportedDepthEstimatorParams { kind: DepthKind::Relative, scale: 0.01, ..metric() };
    let error = load(channel("relative", FIXED, Output::Named("depth")), params).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::InvalidParam);
    assert!(error.to_string().contains("leave scale out"), "{error}");
}

#[test]
fn an_input_of_dynamic_size_has_the_aspect_ratio_of_the_image() {
    let size = |keep_aspect, multiple| {
        let input = InputParams { size: Some(64), ..metric().input };
        let params =
            ImportedDepthEstimatorParams { full_size: false, keep_aspect, multiple, input, ..metric() };
        let path = channel("dynamic", [None, None], Output::Named("predicted_depth"));
        depths(&mut load(path, params).unwrap(), &grey(9, 200, 100)).1
    };
    assert_eq!(size(true, None), [64, 128]);
    assert_eq!(size(true, Some(14)), [70, 126]);
    assert_eq!(size(false, None), [64, 64]);
}

#[test]
fn a_letterboxed_map_is_that_of_its_part_with_the_image() {
    let resize = InputResize::Letterbox;
    for interpolation in [MapInterpolation::Bicubic, MapInterpolation::BilinearCorners] {
        let input = InputParams { resize, padding: Some(0), ..metric().input };
        let params = ImportedDepthEstimatorParams { interpolation, input, ..metric() };
        let sides = [Some(64), Some(64)];
        let mut estimator = load(channel("letterbox", sides, Output::Named("depth")), params).unwrap();
        let (found, shape) = depths(&mut estimator, &grey(200, 128, 64));
        assert_eq!(shape, [64, 128]);
        // The rows at both edges are next to the padding.
        let inside = &found[4 * 128..60 * 128];
        assert!(inside.iter().all(|depth| (depth - 200.0).abs() < 1e-2), "{interpolation:?}");
    }
}

#[test]
fn maps_without_a_name_are_not_taken_for_depths() {
    let recognises = |path: &Path| NetworkKind::DepthEstimator.recognises(&std::fs::read(path).unwrap());
    assert!(recognises(&channel("one", FIXED, Output::Named("inverse_depth"))));
    assert!(!recognises(&channel("mask", FIXED, Output::Named("mask"))));
    let squeezed = channel("two", FIXED, Output::Squeezed);
    assert!(!recognises(&squeezed));
    // Of no other task either: nothing distinguishes depths from a mask.
    for kind in [NetworkKind::Detector, NetworkKind::Segmenter, NetworkKind::Classifier] {
        assert!(!kind.recognises(&std::fs::read(&squeezed).unwrap()), "{kind:?}");
    }
    // The user says what it is.
    let (found, shape) = depths(&mut load(squeezed, metric()).unwrap(), &grey(7, 12, 8));
    assert_eq!((found[0], &shape[..]), (7.0, &[8, 12][..]));
}

#[test]
fn what_is_not_stated_is_an_error_that_names_the_parameter() {
    let path = channel("silent", FIXED, Output::Named("depth"));
    let error = load(path.clone(), ImportedDepthEstimatorParams::default()).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    assert!(format!("{error:#}").contains("set kind, resize, colour, levels"), "{error:#}");
    let params = ImportedDepthEstimatorParams { depth_output: Some("disparity".into()), ..metric() };
    let error = load(path, params).err().unwrap();
    assert!(format!("{error:#}").contains("no output \"disparity\""), "{error:#}");
}

#[test]
fn it_is_a_learner() {
    let scratch = std::env::temp_dir().join(format!("opendr-depth-learner-{}", std::process::id()));
    let calls = [[64, 64], [80, 50], [31, 90]];
    let calls = calls.map(|[width, height]| vec![fixture_image(width, height).into()]);
    check_trained_learner::<ImportedDepthEstimator>(&fixture("yolo_depth.zip"), &scratch, calls.into());
    std::fs::remove_dir_all(&scratch).ok();
}
