//! Tests with the real networks: hands of FreiHAND, tracks, unusual images.

use std::env;
use std::path::{Path, PathBuf};

use opendr_engine::learner::Handle;
use opendr_engine::model::{Manifest, ModelWriter};
use opendr_engine::target::Skeleton;

use super::*;

/// Returns the folder of `OPENDR_TEST_DATA`.
fn shared() -> Option<PathBuf> {
    let shared = env::var_os("OPENDR_TEST_DATA").map(PathBuf::from);
    if shared.is_none() {
        println!("skipped: no OPENDR_TEST_DATA");
    }
    shared
}

fn handle(shared: &Path, params: HandPoseParams) -> Handle<HandPose> {
    let read = |name: &str| std::fs::read(shared.join("models/hand").join(name)).unwrap();
    let folder = env::temp_dir().join(format!(
        "opendr-hand-pose-{}-{:?}",
        std::process::id(),
        std::thread::current().id()
    ));
    let mut writer = ModelWriter::new(&folder, Manifest::new("hand_pose", "lite")).unwrap();
    let [palm, landmarks] = FILES;
    writer.add(palm, &read("palm_detection_lite_192.onnx")).unwrap();
    writer.add(landmarks, &read("hand_landmark_lite_224.onnx")).unwrap();
    let model = writer.finish().unwrap();
    let mut handle = Handle::new(params, Device::Cpu).unwrap();
    handle.load_model(model).unwrap();
    std::fs::remove_dir_all(folder).unwrap();
    handle
}

fn single() -> HandPoseParams {
    HandPoseParams { track: false, ..HandPoseParams::default() }
}

/// Returns the annotated hands of FreiHAND: image, joints, longer side of the box.
fn freihand(shared: &Path) -> Vec<(Image, Vec<[f32; 2]>, f32)> {
    let folder = shared.join("data/mmpose_samples/freihand");
    let text = std::fs::read_to_string(folder.join("test_freihand.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let number = |value: &serde_json::Value| value.as_f64().unwrap() as f32;
    let annotations = json["annotations"].as_array().unwrap();
    let hand = |annotation: &serde_json::Value| {
        let image = opendr_vision::open(folder.join(format!("{:08}.jpg", annotation["image_id"].as_u64()?)));
        let numbers: Vec<f32> = annotation["keypoints"].as_array()?.iter().map(number).collect();
        let joints = numbers.chunks_exact(3).map(|joint| [joint[0], joint[1]]).collect();
        let side = number(&annotation["bbox"][2]).max(number(&annotation["bbox"][3]));
        Some((image.unwrap(), joints, side))
    };
    annotations.iter().map(|annotation| hand(annotation).unwrap()).collect()
}

#[test]
fn joints_lie_where_freihand_has_them() {
    let Some(shared) = shared() else { return };
    let mut handle = handle(&shared, single());
    let (mut right, mut count, mut found, mut right_hands) = (0, 0, 0, 0);
    for (image, joints, side) in freihand(&shared) {
        let poses = handle.infer(&image).unwrap().poses;
        count += joints.len();
        let Some(pose) = poses.first() else { continue };
        found += 1;
        right_hands += usize::from(pose.skeleton == Skeleton::RightHand21);
        let near = |(point, [x, y]): (&Keypoint, &[f32; 2])| (point.x - x).hypot(point.y - y) < 0.2 * side;
        right += pose.keypoints.iter().zip(&joints).filter(|pair| near(*pair)).count();
    }
    let pck = right as f32 / count as f32;
    println!("{found} of 8 hands found, {right_hands} of them right hands, PCK@0.2 {pck:.3}");
    assert_eq!(count, 8 * JOINTS);
    assert!(pck >= 0.65, "{pck}");
    // All hands of FreiHAND are right hands.
    assert!(2 * right_hands > found);
}

#[test]
fn streams_are_separate_and_reset_clears() {
    let Some(shared) = shared() else { return };
    let mut handle = handle(&shared, HandPoseParams { max_hands: 1, ..HandPoseParams::default() });
    let hands = freihand(&shared);
    let predictions = |handle: &mut Handle<HandPose>| -> Vec<PoseList> {
        hands.iter().map(|(image, ..)| handle.infer(image).unwrap()).collect()
    };
    let first = predictions(&mut handle);
    assert!(first.iter().flat_map(|poses| &poses.poses).all(|pose| pose.id.is_some()));
    handle.reset();
    assert_eq!(predictions(&mut handle), first);
    // A hand that stays keeps its identity, and is tracked without palm detection.
    handle.reset();
    let (image, ..) = &hands[0];
    let once = handle.infer(image).unwrap();
    let again = handle.infer(image).unwrap();
    assert_eq!(once.poses.len(), 1);
    assert_eq!((once.poses[0].id, again.poses[0].id), (Some(0), Some(0)));
    let [left, top, width, height] = once.poses[0].bounding_box().unwrap();
    let moved = again.poses[0].bounding_box().unwrap();
    assert!((moved[0] - left).abs() < 0.15 * width && (moved[1] - top).abs() < 0.15 * height);
    let mut stream = handle.stream().unwrap();
    let other = stream.infer(&hands[4].0).unwrap();
    handle.reset();
    assert_eq!(handle.infer(&hands[4].0).unwrap(), other);
}

#[test]
fn images_without_hands_have_none() {
    let Some(shared) = shared() else { return };
    let mut handle = handle(&shared, HandPoseParams::default());
    for (width, height) in [(1, 1), (640, 2), (640, 480)] {
        let image = Image::from_rgb8(vec![0; width * height * 3], width, height).unwrap();
        assert_eq!(handle.infer(&image).unwrap().poses, []);
    }
    let pixels: Vec<f32> = vec![f32::NAN; 64 * 64 * 3];
    let broken =
        Image::new(pixels, 64, 64, opendr_engine::data::PixelFormat::Rgb, opendr_engine::data::Layout::Hwc);
    if let Ok(broken) = broken {
        assert_eq!(handle.infer(&broken).unwrap().poses, []);
    }
}
