use opendr_engine::Random;
use opendr_engine::model::Model;
use opendr_engine::target::BoundingBox;
use opendr_perception_common::exported_network::{InputColour, InputLevels};
use opendr_perception_testing::test_models::{container, test_data};

use super::*;

fn tracker() -> Option<DeepSort> {
    let model = container("deep_sort", "person_reid/osnet_x0_25_msmt17.onnx", "")?;
    let model = Model::open(model).unwrap();
    let unstated = DeepSort::load(&model, DeepSortParams::default(), Device::Cpu).err().unwrap();
    assert!(unstated.to_string().contains("set colour and levels"), "{unstated}");
    let input = EmbeddingInputParams { colour: InputColour::Rgb, levels: InputLevels::ImageNet };
    Some(DeepSort::load(&model, DeepSortParams { input, ..DeepSortParams::default() }, Device::Cpu).unwrap())
}

fn boxes(places: &[[f32; 4]]) -> BoundingBoxList {
    let found = places.iter().map(|[x0, y0, x1, y1]| BoundingBox::from_corners(0, [*x0, *y0, *x1, *y1], 0.9));
    found.collect::<Vec<_>>().into()
}

/// The three persons of bus.jpg who are completely visible.
const PERSONS: [[f32; 4]; 3] =
    [[50.0, 398.0, 245.0, 903.0], [222.0, 405.0, 345.0, 860.0], [669.0, 392.0, 810.0, 877.0]];

fn ids(output: &TrackingAnnotationList) -> Vec<(i64, f32)> {
    output.annotations.iter().map(|track| (track.id, track.bounding_box.left)).collect()
}

/// Checks that embeddings distinguish persons and are stable under small shifts of the boxes.
#[test]
fn persons_are_identified_by_their_embeddings() {
    let (Some(tracker), Some(photo)) = (tracker(), test_data("data/photos/bus.jpg")) else { return };
    let photo = opendr_vision::open(photo).unwrap();
    let mut embeddings = Vec::new();
    let mut state = DeepSortState::default();
    let input = DeepSortInputs { image: &photo, detections: &boxes(&PERSONS) };
    state.embed_boxes(tracker.params(), &tracker.appearance, &input).unwrap();
    embeddings.clone_from(&state.embeddings);
    let embeddings: Vec<_> = embeddings.chunks_exact(tracker.appearance.length()).collect();
    let cosine = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
    for (one, other) in [(0, 1), (0, 2), (1, 2)] {
        let between = cosine(embeddings[one], embeddings[other]);
        assert!(between < 0.85, "{one} and {other}: {between}");
    }
    let moved = PERSONS.map(|[x0, y0, x1, y1]| [x0 + 6.0, y0 + 8.0, x1 - 4.0, y1 - 6.0]);
    state
        .embed_boxes(
            tracker.params(),
            &tracker.appearance,
            &DeepSortInputs { image: &photo, detections: &boxes(&moved) },
        )
        .unwrap();
    for (person, embedding) in state.embeddings.chunks_exact(512).enumerate() {
        assert!(cosine(embedding, embeddings[person]) > 0.85, "{person}");
    }
}

#[test]
fn identities_stay_with_persons() {
    let (Some(tracker), Some(photo)) = (tracker(), test_data("data/photos/bus.jpg")) else { return };
    let photo = opendr_vision::open(photo).unwrap();
    let (mut state, mut output) = (DeepSortState::default(), TrackingAnnotationList::default());
    for frame in 0..6 {
        let shift = frame as f32;
        let mut places = PERSONS.map(|[x0, y0, x1, y1]| [x0 + shift, y0, x1 + shift, y1]).to_vec();
        if frame % 2 == 1 {
            places.reverse();
        }
        if frame == 3 {
            places.clear();
        }
        let detections = boxes(&places);
        let input = DeepSortInputs { image: &photo, detections: &detections };
        tracker.infer_into(&mut state, input, &mut output).unwrap();
        let expected: Vec<_> = PERSONS.iter().zip(1..).map(|([x0, ..], id)| (id, x0 + shift)).collect();
        assert_eq!(ids(&output), if frame == 3 { vec![] } else { expected }, "frame {frame}");
    }
}

#[test]
fn hostile_frames_never_panic_and_memory_is_bounded() {
    let Some(tracker) = tracker() else { return };
    let photo = Image::from_rgb8(vec![99; 3 * 50 * 40], 50, 40).unwrap();
    let (mut state, mut output) = (DeepSortState::default(), TrackingAnnotationList::default());
    let mut random = Random::new(9);
    for frame in 0..10_000_i64 {
        // Few valid boxes, as the network processes each.
        let count = if frame % 5000 == 0 { 5000 } else { random.below(2) };
        let found = (0..count).map(|_| {
            let strange = [f32::NAN, f32::INFINITY, -1e38, -20.0, 0.0, 1e38];
            let place = [0; 4].map(|_| match random.chance(0.3) {
                true => strange[random.below(strange.len())],
                false => random.uniform(0.0, 50.0),
            });
            BoundingBox::new(
                random.below(2) as i64,
                place[0],
                place[1],
                place[2],
                place[3],
                random.uniform(0.0, 1.2),
            )
        });
        let mut detections = BoundingBoxList::from(found.collect::<Vec<_>>());
        detections.header.stamp_ns = Some(-frame);
        let input = DeepSortInputs { image: &photo, detections: &detections };
        tracker.infer_into(&mut state, input, &mut output).unwrap();
        assert!(state.track_count() <= MOST && output.annotations.len() <= MOST);
    }
}

#[test]
fn boxes_outside_the_image_and_no_boxes_are_no_error() {
    let Some(tracker) = tracker() else { return };
    let photo = Image::from_rgb8(vec![99; 3 * 50 * 40], 50, 40).unwrap();
    let (mut state, mut output) = (DeepSortState::default(), TrackingAnnotationList::default());
    for places in [
        vec![[-90.0, -90.0, -10.0, -5.0], [60.0, 2.0, 80.0, 9.0], [0.0, 0.0, 0.3, 40.0]],
        vec![],
        vec![[f32::NAN; 4]],
    ] {
        for _ in 0..3 {
            let detections = boxes(&places);
            let input = DeepSortInputs { image: &photo, detections: &detections };
            tracker.infer_into(&mut state, input, &mut output).unwrap();
        }
    }
    assert!(output.annotations.is_empty());
}
