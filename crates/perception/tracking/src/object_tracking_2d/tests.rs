//! Tests of all trackers of detections.

use opendr_engine::data::Image;
use opendr_engine::learner::Learner;
use opendr_engine::params::{ParamMap, Params};
use opendr_engine::target::{BoundingBox, BoundingBoxList, TrackingAnnotation, TrackingAnnotationList};
use opendr_engine::{Header, Random};

use super::*;

/// A tracker with its state.
struct Stream<L: Learner> {
    learner: L,
    state: L::State,
    output: TrackingAnnotationList,
}

impl<L> Stream<L>
where
    L: for<'a> Learner<Input<'a> = TrackerInputs<'a>, Target = TrackingAnnotationList>,
{
    fn new(make: impl FnOnce(L::Params) -> L, params: &[(&str, f64)]) -> Self {
        let map: ParamMap =
            params.iter().map(|(name, value)| ((*name).to_owned(), (*value).into())).collect();
        let learner = make(L::Params::from_map(&map).unwrap());
        Self { learner, state: L::State::default(), output: TrackingAnnotationList::default() }
    }

    fn run(&mut self, boxes: Vec<BoundingBox>) -> &[TrackingAnnotation] {
        self.run_with_image(None, boxes)
    }

    fn run_with_image(&mut self, image: Option<&Image>, boxes: Vec<BoundingBox>) -> &[TrackingAnnotation] {
        self.run_at(0, image, boxes)
    }

    fn run_at(
        &mut self,
        stamp: i64,
        image: Option<&Image>,
        boxes: Vec<BoundingBox>,
    ) -> &[TrackingAnnotation] {
        let detections = BoundingBoxList { header: Header::new(stamp, "camera"), ..boxes.into() };
        let input = TrackerInputs { detections: &detections, image };
        self.learner.infer_into(&mut self.state, input, &mut self.output).unwrap();
        &self.output.annotations
    }
}

fn sort(params: &[(&str, f64)]) -> Stream<Sort> {
    Stream::new(Sort::with_params, params)
}

fn byte_track(params: &[(&str, f64)]) -> Stream<ByteTrack> {
    Stream::new(ByteTrack::with_params, params)
}

fn oc_sort(params: &[(&str, f64)]) -> Stream<OcSort> {
    Stream::new(OcSort::with_params, params)
}

fn person(x: f32, y: f32, confidence: f32) -> BoundingBox {
    BoundingBox::new(1, x, y, 40.0, 100.0, confidence)
}

/// Runs the same check on each tracker.
macro_rules! each {
    ($params:expr, |$tracker:ident| $check:expr) => {{
        let mut $tracker = sort($params);
        $check;
        let mut $tracker = byte_track($params);
        $check;
        let mut $tracker = oc_sort($params);
        $check;
    }};
}

#[test]
fn two_persons_who_walk_keep_their_numbers() {
    each!(&[], |tracker| for frame in 0..40 {
        let at = frame as f32 * 3.0;
        let mut boxes = vec![person(at, 50.0, 0.9), person(300.0 - at, 120.0, 0.9)];
        if frame % 2 == 1 {
            boxes.reverse();
        }
        let expected = boxes.clone();
        let found = tracker.run(boxes);
        let mut ids: Vec<_> = found.iter().map(|track| track.id).collect();
        ids.sort_unstable();
        assert_eq!(ids, [1, 2], "frame {frame}");
        for track in found {
            assert_eq!(track.frame, Some(frame + 1));
            let height = if track.id == 1 { 50.0 } else { 120.0 };
            let first = found.iter().find(|other| other.id == 1).unwrap();
            assert_eq!(first.bounding_box.top == 50.0, track.bounding_box.top == height);
            assert!(expected.contains(&track.bounding_box));
        }
    });
}

#[test]
fn an_occluded_object_keeps_its_identity() {
    let hidden = |frame: i64| (15..22).contains(&frame);
    let walk = |frame: i64| {
        if hidden(frame) { Vec::new() } else { vec![person(frame as f32 * 4.0, 50.0, 0.9)] }
    };
    for frame in 0..40 {
        assert!(byte_track(&[]).run(walk(frame)).len() <= 1);
    }
    let (mut byte_track, mut oc_sort) = (byte_track(&[]), oc_sort(&[]));
    for frame in 0..40 {
        for found in [byte_track.run(walk(frame)), oc_sort.run(walk(frame))] {
            let ids: Vec<_> = found.iter().map(|track| track.id).collect();
            assert_eq!(ids, if hidden(frame) { vec![] } else { vec![1] }, "frame {frame}");
        }
    }
}

#[test]
fn a_false_detection_is_not_confirmed() {
    each!(&[("min_hits", 3.0)], |tracker| for frame in 0..30 {
        let mut boxes = vec![person(50.0, 50.0, 0.9)];
        if frame == 12 {
            boxes.push(person(400.0, 50.0, 0.9));
        }
        assert_eq!(tracker.run(boxes).len(), 1, "frame {frame}");
    });
}

#[test]
fn low_scores_resume_tracks_but_start_none() {
    let mut tracker = byte_track(&[]);
    for frame in 0..20 {
        let confidence = if frame < 5 { 0.9 } else { 0.3 };
        let found = tracker.run(vec![person(50.0, 50.0, confidence), person(300.0, 50.0, 0.3)]);
        assert_eq!(found.len(), 1, "frame {frame}");
        assert_eq!(found[0].id, 1);
    }
}

#[test]
fn classes_match_only_without_per_class() {
    let walk = |frame: i64| BoundingBox { name: (frame % 2).into(), ..person(50.0, 50.0, 0.9) };
    let (mut strict, mut free) = (oc_sort(&[("min_hits", 1.0)]), oc_sort(&[("min_hits", 1.0)]));
    free.learner.params_mut().per_class = false;
    for frame in 0..4 {
        assert_eq!(strict.run(vec![walk(frame)])[0].id, 1 + frame % 2);
        assert_eq!(free.run(vec![walk(frame)])[0].id, 1);
    }
}

/// Returns smooth noise of a fixed seed, coarse and fine, from a camera at `shift` pixels to the right.
fn scene(shift: usize) -> Image {
    let noise = |x: usize, y: usize, cell: usize| {
        let corner = |across: usize, down: usize| {
            let place = [cell as u64, (x / cell + across) as u64, (y / cell + down) as u64];
            Random::from_key(place).unit()
        };
        let [across, down] = [x, y].map(|at| (at % cell) as f64 / cell as f64);
        let row = |down| corner(0, down) + across * (corner(1, down) - corner(0, down));
        row(0) + down * (row(1) - row(0))
    };
    let grey = |at: usize| {
        let (x, y) = (at % 640 + shift, at / 640);
        (150.0 * noise(x, y, 60) + 100.0 * noise(x, y, 12)) as u8
    };
    let samples = (0..640 * 480).flat_map(|at| [grey(at); 3]).collect();
    Image::from_rgb8(samples, 640, 480).unwrap()
}

/// The camera turns so fast that no box overlaps the one before.
#[test]
fn camera_motion_is_compensated() {
    let shift = |frame: usize| 48 * frame.saturating_sub(2);
    let still = |frame: usize| vec![person(500.0 - shift(frame) as f32, 200.0, 0.9)];
    let scenes: Vec<_> = (0..5).map(|frame| scene(shift(frame))).collect();
    each!(&[("min_hits", 1.0)], |tracker| {
        for (frame, scene) in scenes.iter().enumerate() {
            let found = tracker.run_with_image(Some(scene), still(frame));
            assert_eq!(found.iter().map(|track| track.id).collect::<Vec<_>>(), [1], "frame {frame}");
        }
    });
    let mut blind = byte_track(&[("min_hits", 1.0)]);
    let last = (0..5).map(|frame| blind.run(still(frame))[0].id).last();
    assert_ne!(last, Some(1));
}

#[test]
fn hostile_frames_never_panic_and_memory_is_bounded() {
    let mut random = Random::new(3);
    let mut frame = |at: usize| -> Vec<BoundingBox> {
        let count = match at % 1000 {
            0 => 5000,
            _ => random.below(40),
        };
        let strange = |random: &mut Random| match random.below(16) {
            0 => f32::NAN,
            1 => f32::INFINITY,
            2 => -1e38,
            3 => 1e38,
            4 => 0.0,
            5 => -20.0,
            _ => random.uniform(0.0, 500.0),
        };
        let mut one = || {
            let [left, top, width, height] = [0; 4].map(|_| strange(&mut random));
            let confidence = if random.chance(0.05) { f32::NAN } else { random.uniform(-0.5, 1.5) };
            BoundingBox::new(random.below(3) as i64, left, top, width, height, confidence)
        };
        (0..count).map(|_| one()).collect()
    };
    let frames: Vec<_> = (0..10_000).map(&mut frame).collect();
    // Tracks are kept for long, and time runs backwards.
    each!(&[], |tracker| for (at, boxes) in frames.iter().enumerate() {
        let most = boxes.len();
        let found = tracker.run_at(-(at as i64), None, boxes.clone());
        assert!(found.len() <= most.min(crate::tracking::MAX_BOXES));
        let mut ids: Vec<_> = found.iter().map(|track| track.id).collect();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), found.len(), "no number twice");
        assert!(found.iter().all(|track| track.id > 0 && track.bounding_box.corners().iter().all(|edge| edge.is_finite())));
        assert!(tracker.state.track_count() <= crate::tracking::MAX_BOXES);
    });
}

#[test]
fn the_same_frames_give_the_same_outputs() {
    each!(&[], |tracker| {
        let mut random = Random::new(5);
        let frames: Vec<Vec<_>> = (0..60)
            .map(|_| {
                (0..12).map(|_| person(random.uniform(0.0, 300.0), random.uniform(0.0, 200.0), 0.9)).collect()
            })
            .collect();
        let outputs = [0, 1].map(|_| {
            tracker.state = Default::default();
            frames.iter().map(|frame| tracker.run(frame.clone()).to_vec()).collect::<Vec<_>>()
        });
        assert_eq!(outputs[0], outputs[1]);
        assert!(outputs[0].iter().flatten().count() > 30);
    });
}
