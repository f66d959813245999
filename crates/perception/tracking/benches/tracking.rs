//! Trackers with 25 objects, and their parts; `benches/tracking.py` compares with Python.
//!
//! `cargo bench -p opendr-tracking --bench tracking`

#![allow(missing_docs)]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use opendr_engine::Random;
use opendr_engine::data::Image;
use opendr_engine::learner::Learner;
use opendr_engine::target::{BoundingBox, BoundingBoxList, TrackingAnnotationList};
use opendr_tracking::object_tracking_2d::{ByteTrack, OcSort, Sort, TrackerInputs};
use opendr_tracking::tracking::camera_motion::CameraMotion;
use opendr_tracking::tracking::{AreaFilter, HeightFilter, SparseAssignment};

/// Returns frames of 25 persons who walk to the right, one in twenty undetected.
fn frames() -> Vec<BoundingBoxList> {
    let mut random = Random::new(0);
    let frame = |at: usize| {
        let walkers = (0..25).filter_map(|walker| {
            let left = (walker * 70 + at * (1 + walker % 3)) as f32 % 1800.0 + random.uniform(-1.0, 1.0);
            let top = (walker * 131 % 900) as f32;
            (!random.chance(0.05)).then(|| BoundingBox::new(0, left, top, 50.0, 120.0, 0.9))
        });
        walkers.collect::<Vec<_>>().into()
    };
    (0..500).map(frame).collect()
}

fn track<L>(criterion: &mut Criterion, name: &str, tracker: &L, frames: &[BoundingBoxList])
where
    L: for<'a> Learner<Input<'a> = TrackerInputs<'a>, Target = TrackingAnnotationList>,
{
    let (mut state, mut target) = (L::State::default(), TrackingAnnotationList::default());
    let mut next = frames.iter().cycle();
    criterion.bench_function(&format!("tracking/{name}_25_objects"), |bencher| {
        bencher.iter(|| {
            let detections = next.next()?;
            tracker.infer_into(&mut state, TrackerInputs { detections, image: None }, &mut target).ok()
        });
    });
}

fn trackers(criterion: &mut Criterion) {
    let frames = frames();
    track(criterion, "sort", &Sort::with_params(Default::default()), &frames);
    track(criterion, "byte_track", &ByteTrack::with_params(Default::default()), &frames);
    track(criterion, "oc_sort", &OcSort::with_params(Default::default()), &frames);
}

fn parts(criterion: &mut Criterion) {
    let observed = [100.0, 100.0, 150.0, 220.0];
    let mut area = AreaFilter::new(observed);
    criterion.bench_function("tracking/area_filter_step", |bencher| {
        bencher.iter(|| {
            area.predict();
            area.update(black_box(observed));
        });
    });
    let mut height = HeightFilter::new(observed);
    criterion.bench_function("tracking/height_filter_step", |bencher| {
        bencher.iter(|| {
            height.predict();
            height.update(black_box(observed));
        });
    });
    let mut pairing = SparseAssignment::default();
    criterion.bench_function("tracking/pairing_25_by_25_all_proposed", |bencher| {
        bencher.iter(|| {
            pairing.clear();
            for at in 0..625 {
                pairing.propose(at / 25, at % 25, ((at * 37) % 101 + 1) as f64);
            }
            pairing.solve().len()
        });
    });
    let (mut camera, mut random) = (CameraMotion::default(), Random::new(1));
    let samples = (0..1920 * 1080 * 3).map(|_| random.below(256) as u8).collect();
    let Ok(picture) = Image::from_rgb8(samples, 1920, 1080) else { return };
    criterion.bench_function("tracking/camera_motion_1080p", |bencher| {
        bencher.iter(|| camera.update(black_box(&picture), &[]));
    });
}

criterion_group!(benches, trackers, parts);
criterion_main!(benches);
