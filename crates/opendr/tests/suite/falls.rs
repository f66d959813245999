//! Fall detection in images, with the models of the zoo.

use opendr::data::{Image, Pixels};
use opendr::fall_detection::{FallDetector, FallDetectorParams, FallDetectorTargets};
use opendr::learner::Handle;
use opendr::{Device, ErrorKind};

use crate::models::Models;

const FALLEN: i64 = 1;
const UPRIGHT: i64 = 2;

fn count(targets: &FallDetectorTargets, class: i64) -> usize {
    targets.falls.boxes.iter().filter(|person| person.name == class.into()).count()
}

/// The image rotated by a quarter turn.
fn lying(picture: &Image) -> Image {
    let (width, height) = (picture.width(), picture.height());
    let Pixels::U8(pixels) = picture.pixels() else { panic!("no picture of bytes") };
    let turned = (0..width).flat_map(|x| (0..height).rev().map(move |y| 3 * (y * width + x)));
    Image::from_rgb8(
        turned.flat_map(|at| [pixels[at], pixels[at + 1], pixels[at + 2]]).collect(),
        height,
        width,
    )
    .unwrap()
}

#[test]
fn lying_persons_have_fallen() {
    let Some(models) = Models::find() else { return };
    let picture = opendr::vision::open(models.data("photos/bus.jpg")).unwrap();
    let mut handle = Handle::<FallDetector>::new(FallDetectorParams::default(), Device::Cpu).unwrap();
    handle.load(models.get("fall_detector").unwrap()).unwrap();
    let standing = handle.infer(&picture).unwrap();
    assert!(count(&standing, UPRIGHT) >= 2 && count(&standing, FALLEN) == 0, "{}", standing.falls);
    assert!(standing.poses.poses.iter().all(|pose| pose.id.is_some()));
    handle.reset();
    let fallen = handle.infer(&lying(&picture)).unwrap();
    assert!(count(&fallen, FALLEN) >= 1 && count(&fallen, UPRIGHT) == 0, "{}", fallen.falls);
    // Hardly trained on lying persons, but on standing ones.
    handle.load(models.get("fall_detector/openpose_default").unwrap()).unwrap();
    let standing = handle.infer(&picture).unwrap();
    assert!(count(&standing, UPRIGHT) >= 1 && count(&standing, FALLEN) == 0, "{}", standing.falls);
    let mut other = Handle::<FallDetector>::new(FallDetectorParams::default(), Device::Cpu).unwrap();
    let error = other.load(models.get("yunet").unwrap()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidInput, "{error}");
}
