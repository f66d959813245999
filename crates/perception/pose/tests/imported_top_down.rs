//! Top-down pose estimators that other packages exported, beside the packages' own post-processing.
//!
//! `tests/extended/exported_network_fixtures.py` writes the fixtures: small networks with random weights.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::{Path, PathBuf};

use opendr_engine::data::Image;
use opendr_engine::learner::Handle;
use opendr_engine::params::{ParamMap, Params as _};
use opendr_engine::target::{BoundingBox, BoundingBoxList, Name, PoseList, Skeleton};
use opendr_engine::{Device, ErrorKind, Value};
use opendr_perception_testing::fixture_image::fixture_image;
use opendr_perception_testing::learner_checks::check_trained_learner;
use opendr_pose::pose_estimation::{
    ImportedTopDownPoseEstimator, ImportedTopDownPoseEstimatorParams, KeypointLayout, TopDownInputs,
};

/// Largest difference of a position in pixels, or of a score.
const TOLERANCE: f32 = 1e-3;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/imported").join(name)
}

fn numbers(value: &serde_json::Value) -> Vec<f32> {
    value.as_array().unwrap().iter().map(|one| one.as_f64().unwrap() as f32).collect()
}

fn expected(name: &str) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(fixture(&format!("{name}.json"))).unwrap()).unwrap()
}

fn boxes(expected: &serde_json::Value) -> BoundingBoxList {
    let found = expected["boxes"].as_array().unwrap().iter().map(|values| {
        let [left, top, width, height] = numbers(values)[..] else { panic!("{values}") };
        BoundingBox { left, top, width, height, confidence: 0.9, ..BoundingBox::default() }
    });
    BoundingBoxList { boxes: found.collect(), ..BoundingBoxList::default() }
}

fn open(name: &str, params: ImportedTopDownPoseEstimatorParams) -> Handle<ImportedTopDownPoseEstimator> {
    let mut estimator = Handle::<ImportedTopDownPoseEstimator>::new(params, Device::Cpu).unwrap();
    estimator.load(fixture(&format!("{name}.zip"))).unwrap();
    estimator
}

fn poses(
    estimator: &mut Handle<ImportedTopDownPoseEstimator>,
    image: &Image,
    detections: Option<&BoundingBoxList>,
) -> PoseList {
    estimator.infer(TopDownInputs { image, detections }).unwrap()
}

/// Compares the poses of a fixture with those of its package, and returns the parameters.
fn compare(name: &str) -> ImportedTopDownPoseEstimatorParams {
    let expected = expected(name);
    let given: ParamMap = serde_json::from_value(expected["params"].clone()).unwrap();
    let params = ImportedTopDownPoseEstimatorParams {
        keypoint_threshold: 0.0,
        ..ImportedTopDownPoseEstimatorParams::from_map(&given).unwrap()
    };
    let mut estimator = open(name, params);
    let size = [0, 1].map(|side| expected["image"][side].as_u64().unwrap() as usize);
    let detections = boxes(&expected);
    let found = poses(&mut estimator, &fixture_image(size[0], size[1]), Some(&detections)).poses;
    let wanted = expected["poses"].as_array().unwrap();
    assert_eq!(found.len(), wanted.len(), "{name}");
    let mut seen = 0;
    for ((pose, wanted), found_in) in found.iter().zip(wanted).zip(&detections.boxes) {
        assert_eq!(pose.region.as_deref(), Some(found_in), "{name}");
        for (index, keypoint) in wanted.as_array().unwrap().iter().enumerate() {
            let joint = match pose.skeleton {
                Skeleton::Opendr18 => pose.skeleton.joint(Skeleton::Coco17.joints()[index]).unwrap(),
                _ => index,
            };
            let found = &pose.keypoints[joint];
            let [x, y, score] = numbers(keypoint)[..] else { panic!("{keypoint}") };
            let wanted = [x.clamp(0.0, size[0] as f32), y.clamp(0.0, size[1] as f32), score];
            assert_eq!(found.is_detected(), score > 0.0, "{name}, {index}: {found:?} instead of {keypoint}");
            if found.is_detected() {
                let values = [found.x, found.y, found.confidence];
                let is_close =
                    values.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() <= TOLERANCE);
                assert!(is_close, "{name}, {index}: {found:?} instead of {wanted:?}");
                seen += 1;
            }
        }
    }
    assert!(seen > wanted.len() * 2, "{name}: {seen} keypoints");
    estimator.params().clone()
}

#[test]
fn simcc() {
    assert_eq!(compare("simcc").layout, KeypointLayout::Simcc);
}

#[test]
fn heatmaps() {
    assert_eq!(compare("heatmaps").layout, KeypointLayout::Heatmaps);
}

#[test]
fn unbiased_heatmaps() {
    assert_eq!(compare("vitpose").layout, KeypointLayout::UdpHeatmaps);
}

#[test]
fn an_image_without_boxes_shows_one_person() {
    let params = ImportedTopDownPoseEstimatorParams { keypoint_threshold: 0.0, ..Default::default() };
    let mut estimator = open("simcc", params);
    let image = fixture_image(60, 80);
    let whole = BoundingBox { width: 60.0, height: 80.0, confidence: 1.0, ..BoundingBox::default() };
    let whole = BoundingBoxList { boxes: vec![whole], ..BoundingBoxList::default() };
    let found = poses(&mut estimator, &image, None);
    assert_eq!(found.poses.len(), 1);
    assert_eq!(found.poses, poses(&mut estimator, &image, Some(&whole)).poses);
    let none = BoundingBoxList::default();
    assert!(poses(&mut estimator, &image, Some(&none)).poses.is_empty());
}

#[test]
fn boxes_of_other_classes_and_damaged_ones_have_no_pose() {
    let named = |name: Name, confidence: f32, width: f32| BoundingBox {
        name,
        confidence,
        width,
        height: 80.0,
        ..BoundingBox::default()
    };
    let label = |text: &str| Name::Label(text.into());
    let all = BoundingBoxList {
        boxes: vec![
            named(label("person"), 0.4, 60.0),
            named(label("dog"), 0.9, 60.0),
            named(label("person"), 0.1, 60.0),
            named(Name::Index(3), 0.8, 50.0),
            named(label("person"), 0.9, f32::NAN),
        ],
        ..BoundingBoxList::default()
    };
    let image = fixture_image(60, 80);
    let params = ImportedTopDownPoseEstimatorParams { keypoint_threshold: 0.0, ..Default::default() };
    let regions = |params: ImportedTopDownPoseEstimatorParams| {
        let found = poses(&mut open("simcc", params), &image, Some(&all)).poses;
        found.iter().map(|pose| pose.region.as_ref().unwrap().confidence).collect::<Vec<_>>()
    };
    assert_eq!(regions(params.clone()), [0.4, 0.8]);
    assert_eq!(
        regions(ImportedTopDownPoseEstimatorParams { box_class: "dog".into(), ..params.clone() }),
        [0.9, 0.8]
    );
    assert_eq!(
        regions(ImportedTopDownPoseEstimatorParams { box_class: String::new(), ..params.clone() }).len(),
        3
    );
    // Indices have the names of the list.
    let mut named = all.clone();
    named.classes = ["car", "person", "bus", "dog"].into_iter().collect();
    named.boxes[0].name = Name::Index(1);
    let found = poses(&mut open("simcc", params.clone()), &image, Some(&named)).poses;
    let names: Vec<_> = found.iter().map(|pose| pose.region.as_ref().unwrap().name.to_string()).collect();
    assert_eq!(names, ["person"]);
    // The damaged box has the highest score.
    assert_eq!(regions(ImportedTopDownPoseEstimatorParams { max_poses: 2, ..params }), [0.8]);
}

#[test]
fn what_does_not_fit_is_refused() {
    let load = |name: &str, params: ImportedTopDownPoseEstimatorParams| {
        let mut estimator = Handle::<ImportedTopDownPoseEstimator>::new(params, Device::Cpu).unwrap();
        let error = estimator.load(fixture(&format!("{name}.zip"))).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Unsupported);
        format!("{error:#}")
    };
    let error = load("heatmaps", ImportedTopDownPoseEstimatorParams::default());
    assert!(error.contains("set layout, colour, levels"), "{error}");
    let layout = KeypointLayout::Heatmaps;
    let error = load("simcc", ImportedTopDownPoseEstimatorParams { layout, ..Default::default() });
    assert!(error.contains("no outputs of the layout heatmaps"), "{error}");
}

#[test]
fn it_is_a_learner() {
    let scratch = std::env::temp_dir().join(format!("opendr-top-down-{}", std::process::id()));
    let calls = [[64, 48], [80, 80], [31, 90]].map(|[width, height]| {
        let found = BoundingBox { width: 30.0, height: 40.0, confidence: 0.8, ..BoundingBox::default() };
        let boxes = BoundingBoxList { boxes: vec![found; width / 30], ..BoundingBoxList::default() };
        vec![Value::from(fixture_image(width, height)), boxes.into()]
    });
    check_trained_learner::<ImportedTopDownPoseEstimator>(&fixture("simcc.zip"), &scratch, calls.into());
    std::fs::remove_dir_all(&scratch).ok();
}
