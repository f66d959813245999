//! Tests of the whole detector: training on synthetic images, export, loading, the learner's contract.

use std::path::PathBuf;

use opendr_engine::data::Image;
use opendr_engine::dataset::{Dataset, DatasetIterator, DatasetRef, Sample};
use opendr_engine::learner::{CheckOptions, Fit, FitJob, Handle, check_learner};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes};
use opendr_engine::{Device, ErrorKind, Header, Random, Result, Statistics, Value};
use opendr_training::{ScheduleKind, TrainingParams};

use super::fit::Backbone;
use super::{LayoutParams, SingleShotDetector, SingleShotDetectorFitParams, SingleShotDetectorParams};

/// Synthetic images of one bright box on noise.
struct Synthetic(usize);

const SIDE: usize = 96;

impl Dataset for Synthetic {}

impl DatasetIterator for Synthetic {
    fn len(&self) -> usize {
        self.0
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let mut random = Random::from_key([3, index as u64]);
        let mut pixels: Vec<u8> = (0..SIDE * SIDE * 3).map(|_| random.below(90) as u8).collect();
        let [width, height] = [0, 1].map(|_| 24 + random.below(32));
        let [left, top] = [random.below(SIDE - width), random.below(SIDE - height)];
        let class = index % 2;
        for (row, column) in
            (top..top + height).flat_map(|row| (left..left + width).map(move |column| (row, column)))
        {
            pixels[(row * SIDE + column) * 3 + 2 * class] = 250;
        }
        let found = [left, top, width, height].map(|side| side as f32);
        let found = BoundingBox::new(class as i64, found[0], found[1], found[2], found[3], 1.0);
        let list = BoundingBoxList { classes: self.classes(), ..vec![found].into() };
        let image = Image::from_rgb8(pixels, SIDE, SIDE)?.with_header(Header::new(1 + index as i64, "drawn"));
        Ok(Sample { data: vec![image.into()], target: Some(list.into()) })
    }

    fn classes(&self) -> Classes {
        ["red", "blue"].into_iter().collect()
    }
}

fn fit_params(steps: usize) -> SingleShotDetectorFitParams {
    let training = TrainingParams {
        epochs: steps,
        batch_size: 4,
        num_workers: 0,
        lr: 2e-3,
        lr_schedule: ScheduleKind::Constant,
        warmup_steps: 0,
        ..SingleShotDetectorFitParams::default().training
    };
    SingleShotDetectorFitParams {
        backbone: Backbone::MobileNet025,
        layout: LayoutParams {
            img_size: SIDE,
            stride: 16,
            anchor_scales: vec![2.0, 3.0],
            aspect_ratios: vec![1.0],
            ..LayoutParams::default()
        },
        augment: false,
        training,
        ..SingleShotDetectorFitParams::default()
    }
}

fn scratch(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("opendr-ssd-{name}-{}", std::process::id()));
    std::fs::remove_dir_all(&folder).ok();
    folder
}

fn trained(
    base: Option<&Model>,
    params: &SingleShotDetectorFitParams,
    job: &FitJob<'_>,
) -> Result<Statistics> {
    let dataset = Synthetic(4);
    let dataset: DatasetRef<'_> = (&dataset as &dyn DatasetIterator).into();
    SingleShotDetector::fit(base, &SingleShotDetectorParams::default(), params, dataset, None, job)
}

#[test]
fn an_overfitted_batch_is_detected() {
    let folder = scratch("overfit");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
    let statistics = trained(None, &fit_params(300), &job).unwrap();
    let losses = &statistics.curves["loss"];
    let (first, last) = (losses[0], losses[losses.len() - 1]);
    assert!(last < 0.05 * first, "{first} {last}");

    let params = SingleShotDetectorParams { threshold: 0.5, ..Default::default() };
    let mut learner = Handle::<SingleShotDetector>::new(params, Device::Cpu).unwrap();
    learner.load(job.model()).unwrap();
    for index in 0..4 {
        let Sample { data, target } = Synthetic(4).get(index).unwrap();
        let (Value::Image(image), Some(Value::BoundingBoxList(expected))) = (&data[0], target) else {
            panic!()
        };
        let found = learner.infer(image).unwrap();
        let [found] = &found.boxes[..] else { panic!("{found:#}") };
        assert_eq!(found.name, expected.boxes[0].name);
        let overlap =
            opendr_perception_common::suppression::iou(&found.corners(), &expected.boxes[0].corners());
        assert!(overlap > 0.7, "{found} {overlap}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_trained_container_passes_the_learner_checks() {
    let folder = scratch("promises");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
    trained(None, &fit_params(1), &job).unwrap();
    let calls: Vec<_> =
        (0..3).map(|index| vec![("image", Synthetic(3).get(index).unwrap().data.remove(0))]).collect();
    let registry = opendr_engine::learners![SingleShotDetector];
    let entry = registry.find("single_shot_detector").unwrap();
    let options = CheckOptions { model: &job.model(), scratch: &folder, calls: &calls };
    check_learner(entry, &options).unwrap();
    assert!(entry.capabilities.fit);
    std::fs::remove_dir_all(folder).unwrap();
}

/// Returns the box with the highest score of each image.
fn best(container: PathBuf) -> Vec<BoundingBox> {
    let params = SingleShotDetectorParams { threshold: 0.0, ..Default::default() };
    let mut learner = Handle::<SingleShotDetector>::new(params, Device::Cpu).unwrap();
    learner.load(container).unwrap();
    let images = (0..4).map(|index| Synthetic(4).get(index).unwrap().data.remove(0));
    images
        .map(|image| {
            let Value::Image(image) = image else { panic!() };
            learner.infer(&image).unwrap().boxes.remove(0)
        })
        .collect()
}

#[test]
fn training_resumes_from_a_container_with_the_same_or_other_classes() {
    let folder = scratch("base");
    let outputs = ["first", "same", "other", "wider"].map(|name| folder.join(name));
    let [first, same, other, wider] =
        outputs.each_ref().map(|output| FitJob { device: Device::Cpu, ..FitJob::new(output) });
    trained(None, &fit_params(20), &first).unwrap();
    let base = Model::open(first.model()).unwrap();

    // At a learning rate of 0 the network does not change.
    let mut still = fit_params(1);
    still.training.lr = 0.0;
    trained(Some(&base), &still, &same).unwrap();
    for (before, after) in best(first.model()).iter().zip(best(same.model())) {
        assert_eq!(before.name, after.name);
        assert!((before.confidence - after.confidence).abs() < 1e-4, "{before} {after}");
        assert!(
            opendr_perception_common::suppression::iou(&before.corners(), &after.corners()) > 0.999,
            "{before} {after}"
        );
    }

    still.classes = vec!["blue".to_owned()];
    trained(Some(&base), &still, &other).unwrap();
    assert_eq!(Model::open(other.model()).unwrap().classes().iter().collect::<Vec<_>>(), ["blue"]);

    still.backbone = Backbone::MobileNet050;
    let error = trained(Some(&base), &still, &wider).unwrap_err();
    assert!(error.to_string().contains("mobilenet0.5"), "{error}");
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn invalid_trainings_are_refused() {
    let folder = scratch("report");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
    let classes = SingleShotDetectorFitParams { classes: vec!["green".to_owned()], ..fit_params(1) };
    let error = trained(None, &classes, &job).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidParam);
    assert!(error.to_string().contains("red, blue"), "{error}");
    let layout = LayoutParams { img_size: 100, ..LayoutParams::default() };
    let size = SingleShotDetectorFitParams { layout, ..fit_params(1) };
    assert!(trained(None, &size, &job).unwrap_err().to_string().contains("96 or 128"));
    SingleShotDetectorFitParams::default().check().unwrap();
    std::fs::remove_dir_all(folder).ok();
}
