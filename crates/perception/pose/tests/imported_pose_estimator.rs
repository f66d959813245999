//! Pose estimators that other packages exported, beside the packages' own post-processing.
//!
//! `tests/extended/exported_network_fixtures.py` writes the fixtures: small networks with random weights.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::{Path, PathBuf};

use opendr_engine::learner::Handle;
use opendr_engine::target::{Keypoint, Pose, Skeleton};
use opendr_engine::{Device, ErrorKind};
use opendr_perception_testing::fixture_image::fixture_image;
use opendr_perception_testing::learner_checks::check_trained_learner;
use opendr_pose::pose_estimation::{
    ImportedPoseEstimator, ImportedPoseEstimatorParams, KeypointOrder, PoseLayout,
};

/// Largest difference of a position in pixels, or of a score.
const TOLERANCE: f32 = 1e-3;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/imported").join(name)
}

fn numbers(value: &serde_json::Value) -> Vec<f32> {
    value.as_array().unwrap().iter().map(|one| one.as_f64().unwrap() as f32).collect()
}

/// Compares the poses of a fixture with those of its package, and returns the parameters.
fn compare(name: &str, skeleton: Skeleton) -> ImportedPoseEstimatorParams {
    let expected: serde_json::Value =
        serde_json::from_slice(&std::fs::read(fixture(&format!("{name}.json"))).unwrap()).unwrap();
    let params = ImportedPoseEstimatorParams {
        threshold: expected["threshold"].as_f64().unwrap() as f32,
        iou_threshold: expected["iou_threshold"].as_f64().unwrap() as f32,
        keypoint_threshold: 0.0,
        ..ImportedPoseEstimatorParams::default()
    };
    let mut estimator = Handle::<ImportedPoseEstimator>::new(params, Device::Cpu).unwrap();
    estimator.load(fixture(&format!("{name}.zip"))).unwrap();
    let [width, height] = [0, 1].map(|side| expected["image"][side].as_u64().unwrap() as usize);
    let mut found = estimator.infer(&fixture_image(width, height)).unwrap().poses;
    let wanted = expected["poses"].as_array().unwrap();
    assert!(!wanted.is_empty(), "{name}");
    // Boxes that a package clips to nothing are none.
    let wanted: Vec<_> = wanted
        .iter()
        .map(|pose| (numbers(&pose["box"]), pose["keypoints"].as_array().unwrap()))
        .filter(|(corners, _)| corners[2] > corners[0] && corners[3] > corners[1])
        .collect();
    assert_eq!(found.len(), wanted.len(), "{name}");
    for (corners, keypoints) in wanted {
        let at = found.iter().position(|pose| is_box(pose, &corners));
        let pose = found.remove(at.unwrap_or_else(|| panic!("{name}: no pose has the box {corners:?}")));
        assert_eq!(pose.skeleton, skeleton, "{name}");
        for (index, keypoint) in keypoints.iter().enumerate() {
            let joint = match skeleton {
                Skeleton::Opendr18 => skeleton.joint(Skeleton::Coco17.joints()[index]).unwrap(),
                _ => index,
            };
            assert_keypoint(name, &pose.keypoints[joint], &numbers(keypoint), pose.confidence);
        }
    }
    estimator.params().clone()
}

fn is_box(pose: &Pose, wanted: &[f32]) -> bool {
    let region = pose.region.as_ref().unwrap();
    let values = region.corners().into_iter().chain([pose.confidence]);
    values.zip(wanted).all(|(found, wanted)| (found - wanted).abs() <= TOLERANCE)
}

fn assert_keypoint(name: &str, found: &Keypoint, wanted: &[f32], score: f32) {
    let wanted_score = wanted.get(2).copied().unwrap_or(score);
    let close = [(found.x, wanted[0]), (found.y, wanted[1]), (found.confidence, wanted_score)]
        .into_iter()
        .all(|(found, wanted)| (found - wanted).abs() <= TOLERANCE);
    assert!(close, "{name}: {found:?} instead of {wanted:?}");
}

#[test]
fn candidates() {
    let params = compare("yolo_pose", Skeleton::Points);
    assert_eq!(
        (params.layout, params.keypoints, params.keypoint_values),
        (PoseLayout::Candidates, Some(5), Some(3))
    );
    compare("yolo_pose_pairs", Skeleton::Points);
}

#[test]
fn persons_have_the_joints_of_opendr() {
    let params = compare("yolo_pose_person", Skeleton::Opendr18);
    assert_eq!(params.skeleton, KeypointOrder::Coco17);
}

#[test]
fn detections() {
    for name in ["yolo_pose_end_to_end", "yolo_pose_nms"] {
        assert_eq!(compare(name, Skeleton::Points).layout, PoseLayout::Detections);
    }
}

#[test]
fn weak_keypoints_are_missing() {
    let params =
        ImportedPoseEstimatorParams { threshold: 0.1, keypoint_threshold: 1.0, ..Default::default() };
    let mut estimator = Handle::<ImportedPoseEstimator>::new(params, Device::Cpu).unwrap();
    estimator.load(fixture("yolo_pose.zip")).unwrap();
    let found = estimator.infer(&fixture_image(64, 48)).unwrap().poses;
    assert!(!found.is_empty());
    assert!(found.iter().flat_map(|pose| &pose.keypoints).all(|keypoint| *keypoint == Keypoint::MISSING));
}

#[test]
fn other_numbers_of_keypoints_are_refused() {
    let load = |params: ImportedPoseEstimatorParams| {
        let mut estimator = Handle::<ImportedPoseEstimator>::new(params, Device::Cpu).unwrap();
        let loaded = estimator.load(fixture("yolo_pose.zip"));
        loaded.and_then(|()| estimator.infer(&fixture_image(64, 48)).map(drop)).unwrap_err()
    };
    let error = load(ImportedPoseEstimatorParams { skeleton: KeypointOrder::Coco17, ..Default::default() });
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    assert!(format!("{error:#}").contains("5 keypoints, and the skeleton coco17 17"), "{error:#}");
    let error = load(ImportedPoseEstimatorParams { keypoints: Some(6), ..Default::default() });
    assert!(format!("{error:#}").contains("set layout, keypoints"), "{error:#}");
    let error = load(ImportedPoseEstimatorParams { layout: PoseLayout::Lists, ..Default::default() });
    assert!(format!("{error:#}").contains("no outputs of the layout lists"), "{error:#}");
}

#[test]
fn it_is_a_learner() {
    let scratch = std::env::temp_dir().join(format!("opendr-imported-pose-{}", std::process::id()));
    let calls = [[64, 48], [80, 80], [31, 90]];
    let calls = calls.map(|[width, height]| vec![fixture_image(width, height).into()]);
    check_trained_learner::<ImportedPoseEstimator>(&fixture("yolo_pose.zip"), &scratch, calls.into());
    std::fs::remove_dir_all(&scratch).ok();
}
