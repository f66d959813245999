//! After warm-up, pre- and post-processing of every learner allocate nothing: a call allocates what the bare run of its
//! network allocates, and no more.

#![allow(clippy::unwrap_used)]

mod models;

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

use opendr::data::Image;
use opendr::inference::{Session, TensorView};
use opendr::learner::{Handle, Inputs, Learner};
use opendr::object_tracking_2d::{ByteTrack, OcSort, Sort, TrackerInputs};
use opendr::params::{ParamMap, Params};
use opendr::target::{BoundingBox, BoundingBoxList, TrackingAnnotationList};
use opendr::{Device, Model};

struct Counting;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller keeps the contract of `realloc`.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The fewest allocations of ten calls: other threads of the test runner may allocate meanwhile.
fn fewest(mut call: impl FnMut()) -> usize {
    let count = |_| {
        let before = ALLOCATIONS.load(Ordering::Relaxed);
        call();
        ALLOCATIONS.load(Ordering::Relaxed) - before
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

/// Crowds that walk, for a tracker that has seen them for a while.
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
}

#[test]
fn nothing_is_allocated_around_the_session() {
    let Some(models) = models::Models::find() else { return };
    // Low thresholds: with many candidates.
    use opendr::{face_detection as face, object_detection_2d as detection, pose_estimation as pose};
    check::<detection::CenterNet>(&models, [512, 512], 0.05);
    check::<detection::Nanodet>(&models, [416, 416], 0.05);
    check::<face::Yunet>(&models, [640, 640], 0.1);
    check::<face::UltraLightFace>(&models, [240, 320], 0.1);
    check::<pose::Movenet>(&models, [192, 192], 0.0);
    check::<pose::Posenet>(&models, [385, 385], 0.0);
}
