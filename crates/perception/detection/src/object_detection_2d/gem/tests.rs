//! Tests of the whole detector: training on synthetic pairs, export, loading, the learner's contract.

use std::path::PathBuf;

use opendr_engine::dataset::{Dataset, DatasetIterator, DatasetRef, Sample};
use opendr_engine::learner::{Fit, FitJob, Handle};
use opendr_engine::target::BoundingBox;
use opendr_engine::{ErrorKind, Random, Statistics};
use opendr_perception_common::suppression::iou;
use opendr_perception_testing::learner_checks::check_trained_learner;
use opendr_training::{ScheduleKind, TrainingParams};

use super::drop_sensor::blank;
use super::*;
use crate::object_detection_2d::single_shot_detector::{Backbone, LayoutParams};

/// Synthetic pairs with one object on noise: red in the colour image, bright in the infrared one.
struct Pairs(usize);

const SIDE: usize = 96;

impl Dataset for Pairs {}

impl DatasetIterator for Pairs {
    fn len(&self) -> usize {
        self.0
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (colour, infrared, wanted) = pair(index);
        let target = BoundingBoxList { classes: self.classes(), ..vec![wanted].into() };
        Ok(Sample { data: vec![colour.into(), infrared.into()], target: Some(target.into()) })
    }

    fn classes(&self) -> Classes {
        ["thing"].into_iter().collect()
    }
}

fn pair(index: usize) -> (Image, Image, BoundingBox) {
    let mut random = Random::from_key([11, index as u64]);
    let mut noise = || (0..SIDE * SIDE * 3).map(|_| 30 + random.below(80) as u8).collect::<Vec<_>>();
    let (mut colour, mut infrared) = (noise(), noise());
    let [width, height] = [0, 1].map(|_| 28 + random.below(24));
    let [left, top] = [random.below(SIDE - width), random.below(SIDE - height)];
    for (row, column) in
        (top..top + height).flat_map(|row| (left..left + width).map(move |column| (row, column)))
    {
        let at = (row * SIDE + column) * 3;
        colour[at] = 250;
        infrared[at..at + 3].fill(240);
    }
    let [left, top, width, height] = [left, top, width, height].map(|side| side as f32);
    let image = |levels| Image::from_rgb8(levels, SIDE, SIDE).unwrap();
    (image(colour), image(infrared), BoundingBox::new(0, left, top, width, height, 1.0))
}

fn fit_params(steps: usize, drop_sensor: f32) -> GemFitParams {
    let training = TrainingParams {
        epochs: steps,
        batch_size: 6,
        num_workers: 0,
        lr: 2e-3,
        lr_schedule: ScheduleKind::Constant,
        warmup_steps: 0,
        ..GemFitParams::default().training
    };
    GemFitParams {
        backbone: Backbone::MobileNet025,
        layout: LayoutParams {
            img_size: SIDE,
            stride: 16,
            anchor_scales: vec![2.0, 3.0],
            aspect_ratios: vec![1.0],
            ..LayoutParams::default()
        },
        augment: false,
        drop_sensor,
        training,
        ..GemFitParams::default()
    }
}

fn scratch(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("opendr-gem-{name}-{}", std::process::id()));
    std::fs::remove_dir_all(&folder).ok();
    folder
}

fn trained(base: Option<&Model>, fit_params: &GemFitParams, job: &FitJob<'_>) -> Result<Statistics> {
    let dataset = DatasetRef::from(&Pairs(6) as &dyn DatasetIterator);
    Gem::fit(base, &GemParams::default(), fit_params, dataset, None, job)
}

fn loaded(job: &FitJob<'_>) -> Handle<Gem> {
    let mut learner = Handle::<Gem>::new(GemParams::default(), Device::Cpu).unwrap();
    learner.load(job.model()).unwrap();
    learner
}

#[test]
fn a_failed_sensor_gets_a_lower_weight() {
    let folder = scratch("fails");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
    let statistics = trained(None, &fit_params(400, 0.7), &job).unwrap();
    let losses = &statistics.curves["loss"];
    assert!(losses[losses.len() - 1] < 0.2 * losses[0], "{} {}", losses[0], losses[losses.len() - 1]);

    let mut learner = loaded(&job);
    let mut found = [0; 3];
    for index in 0..6 {
        let (colour, infrared, wanted) = pair(index);
        let (no_colour, no_infrared) = (blank(&colour).unwrap(), blank(&infrared).unwrap());
        let mut predict = |colour: &Image, infrared: &Image| {
            let GemTargets { boxes, sensors } = learner.infer(GemInputs { colour, infrared }).unwrap();
            let [first, second] = sensors.probabilities[..] else { panic!("{sensors:?}") };
            assert!((first + second - 1.0).abs() < 1e-4 && sensors.class == i64::from(second > first));
            let right = boxes.boxes.first().is_some_and(|best| iou(&best.corners(), &wanted.corners()) > 0.5);
            (first, usize::from(right))
        };
        let both = predict(&colour, &infrared);
        let [alone, other] = [predict(&colour, &no_infrared), predict(&no_colour, &infrared)];
        assert!(alone.0 > both.0 && both.0 > other.0, "{alone:?} {both:?} {other:?}");
        assert!(alone.0 > 0.5 && other.0 < 0.5, "{alone:?} {other:?}");
        for (found, (_, right)) in found.iter_mut().zip([both, alone, other]) {
            *found += right;
        }
    }
    assert!(found.iter().all(|found| *found >= 5), "{found:?} of 6");
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_trained_container_passes_the_learner_checks() {
    let folder = scratch("promises");
    let [first, second] = ["first", "second"].map(|name| folder.join(name));
    let [first, second] =
        [&first, &second].map(|output| FitJob { device: Device::Cpu, ..FitJob::new(output) });
    trained(None, &fit_params(1, 0.3), &first).unwrap();
    let calls = (0..3).map(|index| Pairs(3).get(index).unwrap().data).collect();
    check_trained_learner::<Gem>(&first.model(), &folder.join("scratch"), calls);

    // At a learning rate of 0 a further training changes nothing.
    let mut still = fit_params(1, 0.3);
    still.training.lr = 0.0;
    trained(Some(&Model::open(first.model()).unwrap()), &still, &second).unwrap();
    let (colour, infrared, _) = pair(0);
    let [before, after] = [&first, &second]
        .map(|job| loaded(job).infer(GemInputs { colour: &colour, infrared: &infrared }).unwrap().sensors);
    assert!((before.probabilities[0] - after.probabilities[0]).abs() < 1e-3, "{before} {after}");

    let mut learner = loaded(&first);
    let small = Image::from_rgb8(vec![7; 3], 1, 1).unwrap();
    learner.infer(GemInputs { colour: &colour, infrared: &small }).unwrap();
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn invalid_trainings_are_refused() {
    struct Single;
    impl Dataset for Single {}
    impl DatasetIterator for Single {
        fn len(&self) -> usize {
            2
        }

        fn get(&self, index: usize) -> Result<Sample> {
            let mut sample = Pairs(2).get(index)?;
            sample.data.pop();
            Ok(sample)
        }

        fn classes(&self) -> Classes {
            Pairs(1).classes()
        }
    }
    let folder = scratch("report");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
    let dataset = DatasetRef::from(&Single as &dyn DatasetIterator);
    let error = Gem::fit(None, &GemParams::default(), &fit_params(1, 0.0), dataset, None, &job).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidInput);
    assert!(error.to_string().contains("coco_infrared"), "{error}");
    let layout = LayoutParams { img_size: 100, ..LayoutParams::default() };
    let size = GemFitParams { layout, ..fit_params(1, 0.0) };
    assert!(trained(None, &size, &job).unwrap_err().to_string().contains("96 or 128"));
    std::fs::remove_dir_all(folder).ok();
}
