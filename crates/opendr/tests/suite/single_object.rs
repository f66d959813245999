//! Single-object tracking with the real network.

use opendr::data::{Image, Layout, PixelFormat};
use opendr::learner::Handle;
use opendr::object_tracking_2d::{NanoTrack, NanoTrackInputs, NanoTrackParams};
use opendr::target::{BoundingBox, BoundingBoxList, TrackingAnnotationList};
use opendr::{Device, ErrorKind};

use crate::models::Models;

/// What is at `(x, y)` comes to `(x + dx, y + dy)`; where nothing comes, the edge repeats.
fn shifted(image: &Image, [dx, dy]: [i64; 2]) -> Image {
    let (width, height) = (image.width(), image.height());
    let view = image.view();
    let samples = (0..width * height).flat_map(|at| {
        let from = |at: usize, by: i64, side: usize| (at as i64 - by).clamp(0, side as i64 - 1) as usize;
        let (x, y) = (from(at % width, dx, width), from(at / width, dy, height));
        [0, 1, 2].map(|channel| view.sample_u8(x, y, channel))
    });
    Image::new(samples.collect::<Vec<_>>(), width, height, PixelFormat::Rgb, Layout::Hwc).unwrap()
}

/// Photographs with something to follow in each: a face and its eyes, persons, a cat.
const OBJECTS: [(&str, [f32; 4]); 5] = [
    ("photos/astronaut.png", [170.0, 60.0, 110.0, 130.0]),
    ("photos/astronaut.png", [170.0, 60.0, 60.0, 60.0]),
    ("photos/bus.jpg", [222.0, 405.0, 123.0, 455.0]),
    ("photos/bus.jpg", [50.0, 398.0, 195.0, 505.0]),
    ("photos/chelsea.png", [130.0, 60.0, 190.0, 160.0]),
];

/// Tolerance: 8 pixels of the image for an object that is not larger than in the network's input, else 8 of the 127 pixels
/// to which the object and its surroundings are downscaled.
fn allowed([_, _, width, height]: [f32; 4]) -> f32 {
    let context = 0.5 * (width + height);
    let seen = ((width + context) * (height + context)).sqrt();
    if width.max(height) <= 130.0 { 8.0 } else { 8.0 * seen / 127.0 }
}

fn tracker(models: &Models) -> Option<Handle<NanoTrack>> {
    let mut handle = Handle::new(NanoTrackParams::default(), Device::Cpu).unwrap();
    handle.load(models.get("nano_track")?).unwrap();
    Some(handle)
}

fn first(place: [f32; 4]) -> BoundingBoxList {
    let [left, top, width, height] = place;
    vec![BoundingBox::new(7, left, top, width, height, 1.0)].into()
}

#[test]
fn shifts_are_followed_to_within_8_pixels() {
    let Some(models) = Models::find() else { return };
    let Some(mut tracker) = tracker(&models) else { return };
    let mut answer = TrackingAnnotationList::default();
    for (photo, place) in OBJECTS {
        let image = opendr::vision::open(models.data(photo)).unwrap();
        let first = first(place);
        for shift in [[0, 0], [40, 20], [-50, 30], [30, -40]] {
            let input = NanoTrackInputs { image: &image, init_box: Some(&first) };
            tracker.infer_into(input, &mut answer).unwrap();
            assert_eq!(answer.annotations[0].bounding_box.corners(), first.boxes[0].corners());
            let moved = shifted(&image, shift);
            tracker.infer_into(NanoTrackInputs { image: &moved, init_box: None }, &mut answer).unwrap();
            let found = &answer.annotations[0];
            let middle =
                |left: f32, top: f32, width: f32, height: f32| [left + width / 2.0, top + height / 2.0];
            let [x, y] = middle(place[0], place[1], place[2], place[3]);
            let one = &found.bounding_box;
            let [found_x, found_y] = middle(one.left, one.top, one.width, one.height);
            let off = (found_x - x - shift[0] as f32).hypot(found_y - y - shift[1] as f32);
            println!(
                "{photo} {shift:?}: {off:.1} px off, confidence {:.3}, {:.0}x{:.0}",
                one.confidence, one.width, one.height
            );
            assert!(off <= allowed(place), "{photo} {shift:?}: {off} px off");
            assert!(one.confidence > 0.8, "{photo} {shift:?}: {}", one.confidence);
            assert!((one.width / place[2] - 1.0).abs() < 0.25 && (one.height / place[3] - 1.0).abs() < 0.25);
            assert_eq!((found.id, found.frame, one.name.clone()), (0, Some(2), 7.into()));
        }
    }
}

#[test]
fn what_goes_away_is_not_sure() {
    let Some(models) = Models::find() else { return };
    let Some(mut tracker) = tracker(&models) else { return };
    let mut answer = TrackingAnnotationList::default();
    let image = opendr::vision::open(models.data(OBJECTS[0].0)).unwrap();
    let first = first(OBJECTS[0].1);
    tracker.infer_into(NanoTrackInputs { image: &image, init_box: Some(&first) }, &mut answer).unwrap();
    let grey = Image::from_rgb8(vec![120; image.width() * image.height() * 3], image.width(), image.height())
        .unwrap();
    for _ in 0..3 {
        tracker.infer_into(NanoTrackInputs { image: &grey, init_box: None }, &mut answer).unwrap();
    }
    let confidence = answer.annotations[0].bounding_box.confidence;
    assert!(confidence < 0.5, "{confidence}");
}

#[test]
fn odd_frames_are_answered_or_refused() {
    let Some(models) = Models::find() else { return };
    let Some(mut tracker) = tracker(&models) else { return };
    let mut answer = TrackingAnnotationList::default();
    let image = opendr::vision::open(models.data(OBJECTS[0].0)).unwrap();
    let none =
        tracker.infer_into(NanoTrackInputs { image: &image, init_box: None }, &mut answer).unwrap_err();
    assert!(none.kind() == ErrorKind::InvalidInput && none.to_string().contains("init_box"), "{none}");
    let empty = BoundingBoxList::default();
    assert!(
        tracker.infer_into(NanoTrackInputs { image: &image, init_box: Some(&empty) }, &mut answer).is_err()
    );
    let first = first(OBJECTS[0].1);
    tracker.infer_into(NanoTrackInputs { image: &image, init_box: Some(&first) }, &mut answer).unwrap();
    // Other sizes, down to one pixel, from one frame to the next.
    for (width, height) in [(1, 1), (2000, 1), (1, 700), (64, 48), (512, 512)] {
        let picture = Image::from_rgb8(vec![17; width * height * 3], width, height).unwrap();
        tracker.infer_into(NanoTrackInputs { image: &picture, init_box: None }, &mut answer).unwrap();
        let corners = answer.annotations[0].bounding_box.corners();
        assert!(corners.iter().all(|edge| edge.is_finite()), "{width}x{height}: {corners:?}");
    }
    tracker.reset();
    assert!(tracker.infer_into(NanoTrackInputs { image: &image, init_box: None }, &mut answer).is_err());
}
