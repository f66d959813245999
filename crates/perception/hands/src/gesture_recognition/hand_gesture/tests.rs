//! Tests with the zoo's networks and rows of joints: the path of a pointing finger.

use std::f32::consts::TAU;
use std::path::Path;

use opendr_engine::model::{Manifest, ModelWriter};
use opendr_engine::target::{Keypoint, Skeleton};
use opendr_perception_testing::test_models::test_data;

use super::*;

/// Returns a container with the given files and classes.
fn part(folder: &Path, learner: &str, files: &[(&str, Vec<u8>)], classes: &[&str]) -> Model {
    let mut manifest = Manifest::new(learner, "");
    manifest.classes = classes.iter().copied().collect();
    let mut writer = ModelWriter::new(folder.join(learner).join(classes.join("_")), manifest).unwrap();
    files.iter().for_each(|(name, bytes)| writer.add(name, bytes).unwrap());
    writer.finish().unwrap()
}

fn learner() -> Option<HandGesture> {
    let hand = |name: &str| Some(std::fs::read(test_data("models/hand")?.join(name)).unwrap());
    let weights = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../models/weights/keypoint_gesture");
    let gesture = |name: &str| vec![("model.onnx", std::fs::read(weights.join(name)).unwrap())];
    let networks = [
        ("palm.onnx", hand("palm_detection_lite_192.onnx")?),
        ("landmarks.onnx", hand("hand_landmark_lite_224.onnx")?),
    ];
    let folder = std::env::temp_dir().join(format!("opendr-hand-gesture-{}", std::process::id()));
    let mut writer = ModelWriter::new(folder.join("whole"), Manifest::new("hand_gesture", "")).unwrap();
    writer.add_part(HAND, &part(&folder, "hand_pose", &networks, &[])).unwrap();
    let shapes = ["open", "close", "pointer"];
    writer.add_part(SHAPE, &part(&folder, "keypoint_gesture", &gesture("hand.onnx"), &shapes)).unwrap();
    let paths = ["stop", "clockwise", "counterclockwise", "move"];
    writer.add_part(PATH, &part(&folder, "keypoint_gesture", &gesture("path.onnx"), &paths)).unwrap();
    let model = writer.finish().unwrap();
    let learner = HandGesture::load(&model, HandGestureParams::default(), Device::Cpu).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    Some(learner)
}

/// Returns a hand from the rows, of the shape of class `expected`, at `[x, y]`.
fn hand(rows: &str, expected: &str, [x, y]: [f32; 2]) -> Pose {
    let row =
        rows.lines().filter_map(|line| line.split_once(',')).find(|(class, _)| *class == expected).unwrap().1;
    let numbers: Vec<f32> = row.split(',').map(|number| number.parse().unwrap()).collect();
    let joint = |way: &[f32]| Keypoint { x: x + 150.0 * way[0], y: y + 150.0 * way[1], confidence: 0.9 };
    let keypoints = numbers.chunks_exact(2).map(joint).collect();
    Pose { keypoints, id: Some(3), skeleton: Skeleton::RightHand21, ..Pose::default() }
}

#[test]
fn paths_of_a_pointing_finger_are_classified() {
    let Some(learner) = learner() else { return };
    let rows = test_data("models/hand/gesture_keypoint/keypoint.csv").unwrap();
    let rows = std::fs::read_to_string(rows).unwrap();
    let predictions = |shape: &str, place: &dyn Fn(f32) -> [f32; 2]| -> Vec<String> {
        let (mut paths, mut gesture) = (Paths::default(), Category::default());
        let mut frame = |at: usize| {
            paths.begin_frame();
            let hand = hand(&rows, shape, place(at as f32));
            let predictions = learner.gesture(&mut paths, &hand, [960, 540], &mut gesture).unwrap().unwrap();
            paths.end_frame();
            learner.classes.name(predictions.0).unwrap().to_string()
        };
        (0..20).map(&mut frame).collect()
    };
    let around = |turn: f32| {
        move |at: f32| {
            let angle = turn * at / 16.0 * TAU;
            [480.0 + 100.0 * angle.cos(), 300.0 + 100.0 * angle.sin()]
        }
    };
    type Way<'a> = &'a dyn Fn(f32) -> [f32; 2];
    let ways: [(Way<'_>, &str); 4] = [
        (&|_| [500.0, 300.0], "stop"),
        (&around(1.0), "clockwise"),
        (&around(-1.0), "counterclockwise"),
        (&|at| [300.0 + 20.0 * at, 200.0 + 5.0 * at], "move"),
    ];
    for (place, expected) in ways {
        let pointing = predictions("2", place);
        assert!(pointing[..POINTS - 1].iter().all(|gesture| gesture == "pointer"), "{pointing:?}");
        assert!(pointing[POINTS..].iter().all(|gesture| gesture == expected), "{expected}: {pointing:?}");
        assert!(predictions("0", place).iter().all(|gesture| gesture == "open"));
    }
}
