//! Tests that pre- and post-processing of every learner allocate nothing after warm-up: a call allocates no more than the bare
//! run of its network.
//!
//! A program of its own: work of other threads counts, so no other test may run beside these.

#![allow(clippy::unwrap_used)]

#[path = "suite/models/mod.rs"]
mod models;

use opendr::data::{Audio, Image};
use opendr::inference::{Session, TensorView};
use opendr::learner::{Handle, Inputs, Learner};
use opendr::object_tracking_2d::{ByteTrack, CBiou, OcSort, Sort, TrackerInputs};
use opendr::params::{ParamMap, Params};
use opendr::speech_recognition::DsCnn;
use opendr::stereo_matching::{SemiGlobalMatching, SemiGlobalMatchingInputs, SemiGlobalMatchingTargets};
use opendr::target::{BoundingBox, BoundingBoxList, Category, TrackingAnnotationList};
use opendr::{Device, Model};
use opendr_test_allocator::{CountingAllocator, allocations};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

/// Returns the minimum number of allocations of ten calls, since other threads of the test runner may allocate meanwhile.
fn fewest(mut call: impl FnMut()) -> usize {
    let count = |_| {
        let before = allocations();
        call();
        allocations() - before
    };
    (0..10).map(count).min().unwrap_or(0)
}

fn check<L>(models: &models::Models, size: [usize; 2], threshold: f64)
where
    L: for<'a> Learner<Input<'a> = &'a Image>,
    for<'a> &'a Image: Inputs<'a>,
{
    let name = L::SPEC.name;
    let Some(path) = models.get(name) else { return };
    let params = L::Params::from_map(&ParamMap::from([("threshold".to_owned(), threshold.into())])).unwrap();
    let mut handle = Handle::<L>::new(params, Device::Cpu).unwrap();
    handle.load(&path).unwrap();
    let image = opendr::vision::open(models.data("photos/t1.jpg")).unwrap();
    let mut target = L::Target::default();
    (0..3).for_each(|_| handle.infer_into(&image, &mut target).unwrap());
    let whole = fewest(|| handle.infer_into(&image, &mut target).unwrap());

    let session =
        Session::open(&Model::open(&path).unwrap().file("model.onnx").unwrap(), Device::Cpu).unwrap();
    let input = vec![0.0_f32; 3 * size[0] * size[1]];
    let input = [TensorView::new(&[1, 3, size[0], size[1]], &input).unwrap()];
    (0..3).for_each(|_| session.run(&input, |_| Ok(())).unwrap());
    let bare = fewest(|| session.run(&input, |_| Ok(())).unwrap());
    println!("{name}: {whole} allocations a call, {bare} of them in the session's run");
    assert!(whole <= bare, "{name} allocates {whole} times a call, its bare session {bare} times");
}

/// Checks a tracker on walking crowds, after warm-up.
fn check_tracker<L>(make: impl FnOnce(L::Params) -> L)
where
    L: for<'a> Learner<Input<'a> = TrackerInputs<'a>, Target = TrackingAnnotationList>,
{
    let tracker = make(L::Params::from_map(&ParamMap::new()).unwrap());
    let (mut state, mut answer) = (L::State::default(), TrackingAnnotationList::default());
    let mut frames = (0..200).map(|frame| {
        // Some cross, and each is hidden now and then.
        let walkers = (0..25).filter(|walker| (frame + 7 * walker) % 20 != 0).map(|walker| {
            let left = (walker * 60 + frame * (walker % 3)) as f32;
            BoundingBox::new(0, left, (walker % 5) as f32 * 10.0, 50.0, 120.0, 0.9)
        });
        BoundingBoxList::from(walkers.collect::<Vec<_>>())
    });
    let mut call = |frame: &BoundingBoxList| {
        let input = TrackerInputs { detections: frame, image: None };
        tracker.infer_into(&mut state, input, &mut answer).unwrap();
    };
    frames.by_ref().take(180).for_each(|frame| call(&frame));
    let rest: Vec<_> = frames.collect();
    let mut rest = rest.iter();
    assert_eq!(fewest(|| call(rest.next().unwrap())), 0, "{}", L::SPEC.name);
    assert!(answer.annotations.len() > 15);
}

#[test]
fn trackers_allocate_nothing() {
    check_tracker(Sort::with_params);
    check_tracker(ByteTrack::with_params);
    check_tracker(OcSort::with_params);
    check_tracker(CBiou::with_params);
}

#[test]
fn stereo_allocates_nothing() {
    let wishes = [("focal_length", 300.0), ("baseline", 0.1), ("camera_height", 1.0)];
    let wishes = wishes.map(|(name, value)| (name.to_owned(), value.into()));
    let matcher = SemiGlobalMatching::with_params(Params::from_map(&ParamMap::from(wishes)).unwrap());
    let picture = |shift: usize| {
        let level = |at: usize| ((at % 160 + shift).pow(2) * 7 + at / 160 * 31) as u8;
        Image::from_rgb8((0..160 * 120).flat_map(|at| [level(at); 3]).collect(), 160, 120).unwrap()
    };
    let (left, right, mut answer) = (picture(0), picture(9), SemiGlobalMatchingTargets::default());
    let mut call = || {
        let input = SemiGlobalMatchingInputs { left: &left, right: &right };
        matcher.infer_into(&mut (), input, &mut answer).unwrap();
    };
    (0..3).for_each(|_| call());
    assert_eq!(fewest(call), 0);
}

#[test]
fn words_allocate_nothing_around_the_session() {
    let Some(models) = models::Models::find() else { return };
    let Some(path) = models.get("ds_cnn") else { return };
    let mut handle = Handle::<DsCnn>::new(Params::from_map(&ParamMap::new()).unwrap(), Device::Cpu).unwrap();
    handle.load(&path).unwrap();
    let session =
        Session::open(&Model::open(&path).unwrap().file("model.onnx").unwrap(), Device::Cpu).unwrap();
    let cepstra = [0.0_f32; 49 * 10];
    let input = [TensorView::new(&[1, 1, 49, 10], &cepstra).unwrap()];
    let bare = || session.run(&input, |_| Ok(())).unwrap();
    (0..3).for_each(|_| bare());
    let bare = fewest(bare);
    // A whole second, and one that has to be filled up.
    for samples in [16_000, 9_000] {
        let levels = (0..samples).map(|at| (at as f32 * 0.1).sin()).collect::<Vec<_>>();
        let (sound, mut word) = (Audio::new(levels, 1, 16_000).unwrap(), Category::default());
        let mut call = || handle.infer_into((&sound).into(), &mut word).unwrap();
        (0..3).for_each(|_| call());
        let whole = fewest(call);
        assert!(whole <= bare, "a word allocates {whole} times, its bare session {bare} times");
    }
}

#[test]
fn nothing_is_allocated_around_the_session() {
    let Some(models) = models::Models::find() else { return };
    // Low thresholds: with many candidates.
    use opendr::{face_detection as face, object_detection_2d as detection, pose_estimation as pose};
    check::<detection::CenterNet>(&models, [512, 512], 0.05);
    check::<detection::Nanodet>(&models, [416, 416], 0.05);
    check::<detection::FastestDet>(&models, [352, 352], 0.05);
    check::<face::Yunet>(&models, [640, 640], 0.1);
    check::<face::UltraLightFace>(&models, [240, 320], 0.1);
    check::<pose::Movenet>(&models, [192, 192], 0.0);
    check::<pose::Posenet>(&models, [385, 385], 0.0);
}
