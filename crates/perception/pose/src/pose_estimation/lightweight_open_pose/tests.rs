use std::path::PathBuf;

use opendr_engine::data::{Image, PixelFormat};
use opendr_engine::dataset::{Dataset, DatasetIterator, DatasetRef, Sample};
use opendr_engine::learner::{CheckOptions, Fit as _, FitJob, Handle, check_learner};
use opendr_engine::params::ParamValue;
use opendr_engine::target::BoundingBox;
use opendr_engine::{ErrorKind, Header, Random, Value, learners};

use super::*;
use crate::pose_estimation::part_affinity::JOINTS;

const SIDE: usize = 96;

/// Images of stick figures, each joint with its own colour, annotated with their joints.
struct Figures {
    samples: Vec<Sample>,
}

impl Figures {
    fn new(lefts: &[f32]) -> Self {
        Self { samples: lefts.iter().map(|left| figure(*left)).collect() }
    }
}

impl Dataset for Figures {}

impl DatasetIterator for Figures {
    fn len(&self) -> usize {
        self.samples.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        Ok(self.samples[index].clone())
    }
}

fn joint(left: f32, at: usize) -> Keypoint {
    let (row, column) = (at / 3, at % 3);
    Keypoint { x: left + 16.0 * column as f32, y: 8.0 + 15.0 * row as f32, confidence: 1.0 }
}

fn figure(left: f32) -> Sample {
    let mut pixels = vec![90u8; SIDE * SIDE * 3];
    let joints: Vec<_> = (0..JOINTS).map(|at| joint(left, at)).collect();
    for (at, joint) in joints.iter().enumerate() {
        for (index, pixel) in pixels.chunks_exact_mut(3).enumerate() {
            let (x, y) = ((index % SIDE) as f32 + 0.5, (index / SIDE) as f32 + 0.5);
            if (x - joint.x).hypot(y - joint.y) < 5.0 {
                pixel.copy_from_slice(&[14 * at as u8, 255 - 14 * at as u8, (at * 97 % 256) as u8]);
            }
        }
    }
    let image = Image::from_rgb8(pixels, SIDE, SIDE).unwrap();
    let pose = Pose { keypoints: joints.into_iter().collect(), confidence: 1.0, ..Pose::default() };
    Sample { data: vec![image.into()], target: Some(PoseList::from(vec![pose]).into()) }
}

fn small() -> LightweightOpenPoseFitParams {
    let mut params = LightweightOpenPoseFitParams {
        width: 0.25,
        channels: 24,
        num_refinement_stages: 1,
        crop_size: SIDE,
        augment: false,
        ..Default::default()
    };
    let values: [(&str, ParamValue); 6] = [
        ("lr", 0.003.into()),
        ("epochs", 300i64.into()),
        ("batch_size", 2i64.into()),
        ("weight_decay", 0.0.into()),
        ("num_workers", 1i64.into()),
        ("separable", true.into()),
    ];
    values.into_iter().for_each(|(name, value)| params.set(name, value).unwrap());
    params
}

fn scratch(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("opendr-open-pose-{name}-{}", std::process::id()));
    std::fs::remove_dir_all(&folder).ok();
    folder
}

/// Overfits one batch; the trained container detects the figures and passes the learner checks.
#[test]
fn one_batch_is_overfitted() {
    let folder = scratch("overfit");
    let figures = Figures::new(&[20.0, 34.0]);
    let dataset = DatasetRef::Iterator(&figures);
    let params = LightweightOpenPoseParams { base_height: SIDE, ..LightweightOpenPoseParams::default() };
    let mut learner = Handle::<LightweightOpenPose>::new(params.clone(), Device::Cpu).unwrap();
    let statistics = learner.fit(&small(), dataset, None, &FitJob::new(&folder)).unwrap();
    let loss = &statistics.curves["loss"];
    println!("loss {} to {}", loss[0], loss[loss.len() - 1]);
    assert_eq!(loss.len(), 300);
    assert!(loss[loss.len() - 1] < 0.05 * loss[0], "{loss:?}");
    for (left, stamp) in [(20.0, 1), (34.0, 2)] {
        let Some(Value::Image(image)) = figure(left).data.pop() else { unreachable!() };
        let image = image.with_header(Header::new(stamp, "camera"));
        learner.reset();
        let found = learner.infer(&image).unwrap().poses.clone();
        assert_eq!(found.len(), 1);
        let off = |(at, found): (usize, &Keypoint)| {
            let expected = joint(left, at);
            (found.x - expected.x).hypot(found.y - expected.y)
        };
        let mean = found[0].keypoints.iter().enumerate().map(off).sum::<f32>() / JOINTS as f32;
        assert!(mean < 4.0, "{mean}: {found:?}");
        assert!(found[0].confidence > 0.5 && found[0].confidence <= 1.0 && found[0].id == Some(0));
    }
    passes_the_learner_checks(&folder.join("model"), &folder.join("check"));
    resumes_from(&mut learner, &figures, loss[loss.len() - 1], &folder.join("more"));
    std::fs::remove_dir_all(&folder).ok();
}

fn passes_the_learner_checks(model: &std::path::Path, scratch: &std::path::Path) {
    let registry = Box::leak(Box::new(learners![LightweightOpenPose]));
    let entry = registry.entries()[0];
    let call = |left: f32, stamp: i64| {
        let Some(Value::Image(image)) = figure(left).data.pop() else { unreachable!() };
        vec![("image", Value::from(image.with_header(Header::new(stamp * 40_000_000, "camera"))))]
    };
    let calls = [call(20.0, 1), call(22.0, 2), call(34.0, 3)];
    check_learner(entry, &CheckOptions { model, scratch, calls: &calls }).unwrap();
}

/// Checks that a further training starts from the loss of the first.
fn resumes_from(
    learner: &mut Handle<LightweightOpenPose>,
    figures: &Figures,
    reached: f64,
    folder: &std::path::Path,
) {
    let mut params = small();
    params.set("epochs", 1i64.into()).unwrap();
    // The sizes are those of the container.
    params.channels = 8;
    let statistics = learner.fit(&params, DatasetRef::Iterator(figures), None, &FitJob::new(folder)).unwrap();
    let loss = statistics.curves["loss"][0];
    assert!(loss < 3.0 * reached + 1.0, "{loss} after {reached}");
}

#[test]
fn persons_without_joints_are_ignored() {
    let mut sample = figure(20.0);
    let region = BoundingBox::new(0, 48.0, 0.0, 48.0, 96.0, 1.0);
    let nobody = Pose { region: Some(Box::new(region)), ..Pose::default() };
    if let Some(Value::PoseList(poses)) = &mut sample.target {
        poses.poses.push(nobody);
    }
    use opendr_datasets::loader::Collate as _;
    let batches = objective::PoseBatches::new(SIDE);
    let mut batch = batches.start(2);
    batches.add(&mut batch, figure(20.0)).unwrap();
    let without = Sample { target: None, ..figure(20.0) };
    assert_eq!(batches.add(&mut batch, without).unwrap_err().kind(), ErrorKind::InvalidInput);
    batches.add(&mut batch, sample).unwrap();
    assert_eq!(batch.len(), 2);
    let [first, second] = [0, 1].map(|at| batch.mask_of(at).to_vec());
    assert!(first.iter().all(|cell| *cell == 1.0));
    let right = |at: usize| at % 12 >= 6;
    for (at, cell) in second.iter().enumerate() {
        assert_eq!(*cell == 0.0, right(at), "cell {at}");
    }
}

#[test]
fn crops_contain_persons() {
    use opendr_datasets::augment::{Augment as _, OtherSamples};
    let crop = person_crop::PersonCrop { size: 64, ..Default::default() };
    for seed in 0..20 {
        let mut sample = figure(30.0);
        crop.apply(&mut sample, &mut Random::new(seed), &OtherSamples::none()).unwrap();
        let (Some(Value::Image(image)), Some(Value::PoseList(poses))) = (sample.data.first(), &sample.target)
        else {
            unreachable!()
        };
        assert_eq!((image.width(), image.height(), image.format()), (64, 64, PixelFormat::Rgb));
        let found = poses.poses[0].keypoints.iter().filter(|joint| joint.is_detected()).count();
        assert!(found >= JOINTS / 2, "{found} joints with seed {seed}");
    }
}

#[test]
fn backbones_that_do_not_fit_are_refused() {
    let folder = scratch("backbone");
    let figures = Figures::new(&[20.0]);
    let params = LightweightOpenPoseFitParams { backbone: "no/such.onnx".to_owned(), ..small() };
    let job = FitJob::new(&folder);
    let fit = |params: &LightweightOpenPoseFitParams| {
        let dataset = DatasetRef::Iterator(&figures);
        LightweightOpenPose::fit(None, &LightweightOpenPoseParams::default(), params, dataset, None, &job)
    };
    let error = fit(&params).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::NotFound);
    assert!(error.to_string().contains("no/such.onnx"), "{error}");
    std::fs::remove_dir_all(&folder).ok();
}
