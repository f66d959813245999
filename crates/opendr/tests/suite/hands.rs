//! Hand gestures in images and videos, with the models of the zoo.

use opendr::data::Image;
use opendr::gesture_recognition::{HandGesture, HandGestureParams};
use opendr::learner::Handle;
use opendr::target::BoundingBoxList;
use opendr::{Device, ErrorKind};

use crate::models::Models;

fn handle(models: &Models, track: bool) -> Option<Handle<HandGesture>> {
    let params = HandGestureParams { track, ..Default::default() };
    let mut handle = Handle::new(params, Device::Cpu).unwrap();
    handle.load(models.get("hand_gesture")?).unwrap();
    Some(handle)
}

fn picture(models: &Models, path: &str) -> Image {
    opendr::vision::open(models.data("mmpose_samples").join(path)).unwrap()
}

/// Gestures of the first hand, frame by frame.
fn first(list: &BoundingBoxList) -> Option<&str> {
    list.boxes.first().and_then(|found| list.label(found))
}

#[test]
fn open_hands_and_fists_are_recognised() {
    let Some(models) = Models::find() else { return };
    let Some(mut handle) = handle(&models, false) else { return };
    // As their joints are annotated, these hands are spread, and those are closed around something.
    for (path, wanted) in [
        ("freihand/00000355.jpg", "open"),
        ("freihand/00032915.jpg", "open"),
        ("freihand/00065475.jpg", "open"),
        ("onehand10k/1402.jpg", "open"),
        ("onehand10k/9.jpg", "open"),
        ("freihand/00017620.jpg", "close"),
        ("onehand10k/784.jpg", "close"),
    ] {
        let list = handle.infer(&picture(&models, path)).unwrap();
        assert_eq!(first(&list), Some(wanted), "{path}: {list:#}");
        let found = &list.boxes[0];
        assert!((0.5..=1.0).contains(&found.confidence) && found.area() > 1000.0, "{found:?}");
    }
    let black = Image::from_rgb8(vec![0; 640 * 480 * 3], 640, 480).unwrap();
    assert!(handle.infer(&black).unwrap().boxes.is_empty());
    handle.set("threshold", 1.0.into()).unwrap();
    assert!(handle.infer(&picture(&models, "freihand/00115300.jpg")).unwrap().boxes.is_empty());
    let mut other = Handle::<HandGesture>::new(HandGestureParams::default(), Device::Cpu).unwrap();
    let error = other.load(models.get("hand_pose").unwrap()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidInput, "{error}");
}

#[test]
fn streams_do_not_mix_and_reset_forgets() {
    let Some(models) = Models::find() else { return };
    let Some(mut handle) = handle(&models, true) else { return };
    let video = ["freihand/00000355.jpg", "freihand/00017620.jpg"].map(|path| picture(&models, path));
    let mut other = handle.stream().unwrap();
    let mut predictions = Vec::new();
    for at in 0..4 {
        predictions.push(handle.infer(&video[0]).unwrap());
        other.infer(&video[at % 2]).unwrap();
    }
    handle.reset();
    for answer in &predictions {
        assert_eq!(&handle.infer(&video[0]).unwrap(), answer);
    }
    let classes: Vec<_> = handle.classes().iter().map(str::to_owned).collect();
    assert_eq!(classes, ["open", "close", "pointer", "stop", "clockwise", "counterclockwise", "move"]);
}
