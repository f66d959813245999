//! Tests of the whole network: training on synthetic images, export, loading, the learner's contract.

use std::path::PathBuf;

use opendr_engine::dataset::{Dataset, DatasetIterator, DatasetRef, Sample};
use opendr_engine::learner::{Fit, FitJob, Handle};
use opendr_engine::target::BoundingBox;
use opendr_engine::{ErrorKind, Random, Statistics, Value};
use opendr_perception_common::suppression::iou;
use opendr_perception_testing::learner_checks::check_trained_learner;
use opendr_perception_testing::overfit::losses_on_one_batch;
use opendr_training::{ScheduleKind, TrainingParams};

use super::network::{NetworkSizes, Seq2SeqNmsNetwork};
use super::objective::NmsObjective;
use super::*;

/// Synthetic images with two striped boards, each detected five times, and two false detections.
struct Boards(usize);

const WIDTH: usize = 160;
const HEIGHT: usize = 120;

impl Dataset for Boards {}

impl DatasetIterator for Boards {
    fn len(&self) -> usize {
        self.0
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (image, found, ground_truth) = boards(index);
        Ok(Sample { data: vec![image.into(), found.into()], target: Some(ground_truth.into()) })
    }

    fn classes(&self) -> Classes {
        ["board"].into_iter().collect()
    }
}

fn boards(index: usize) -> (Image, BoundingBoxList, BoundingBoxList) {
    let mut random = Random::from_key([5, index as u64]);
    let mut levels = vec![60u8; WIDTH * HEIGHT * 3];
    let (mut found, mut ground_truth) = (Vec::new(), Vec::new());
    for left in [random.below(20), 80 + random.below(20)] {
        let (top, width, height) = (random.below(30), 40 + random.below(15), 60 + random.below(25));
        for (row, column) in
            (top..top + height).flat_map(|row| (left..left + width).map(move |column| (row, column)))
        {
            levels[(row * WIDTH + column) * 3..][..3].fill(if row % 8 < 4 { 240 } else { 20 });
        }
        let [x, y, w, h] = [left, top, width, height].map(|side| side as f32);
        ground_truth.push(BoundingBox::new(0, x, y, w, h, 1.0));
        for _ in 0..5 {
            let mut near = |side: f32| side * (random.below(21) as f32 / 100.0 - 0.1);
            let corner = [x + near(w), y + near(h), w + near(w), h + near(h)];
            let score = 0.4 + random.below(50) as f32 / 100.0;
            found.push(BoundingBox::new(0, corner[0], corner[1], corner[2], corner[3], score));
        }
    }
    for left in [5.0, 90.0] {
        found.push(BoundingBox::new(0, left, 90.0, 50.0, 28.0, 0.3 + random.below(30) as f32 / 100.0));
    }
    let classes: Classes = ["board"].into_iter().collect();
    let list = |boxes: Vec<BoundingBox>| BoundingBoxList { classes: classes.clone(), ..boxes.into() };
    (Image::from_rgb8(levels, WIDTH, HEIGHT).unwrap(), list(found), list(ground_truth))
}

fn fit_params(epochs: usize, lr: f64) -> Seq2SeqNmsFitParams {
    let training = TrainingParams {
        epochs,
        lr,
        batch_size: 6,
        num_workers: 0,
        lr_schedule: ScheduleKind::Constant,
        ..Seq2SeqNmsFitParams::default().training
    };
    Seq2SeqNmsFitParams { variant: NmsVariant::Light, dropout: 0.0, training, ..Default::default() }
}

fn trained(
    base: Option<&Model>,
    count: usize,
    fit_params: &Seq2SeqNmsFitParams,
    job: &FitJob<'_>,
) -> Result<Statistics> {
    let boards = Boards(count);
    let dataset = DatasetRef::from(&boards as &dyn DatasetIterator);
    Seq2SeqNms::fit(base, &Seq2SeqNmsParams::default(), fit_params, dataset, None, job)
}

fn scratch(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("opendr-seq2seq-nms-{name}-{}", std::process::id()));
    std::fs::remove_dir_all(&folder).ok();
    folder
}

fn loaded(job: &FitJob<'_>, threshold: f32) -> Handle<Seq2SeqNms> {
    let params = Seq2SeqNmsParams { threshold, ..Default::default() };
    let mut learner = Handle::<Seq2SeqNms>::new(params, Device::Cpu).unwrap();
    learner.load(job.model()).unwrap();
    learner
}

#[test]
fn one_batch_is_overfitted() {
    let params = Seq2SeqNmsParams::default();
    let sizes = NetworkSizes { variant: NmsVariant::Light, dropout: 0.0 };
    let classes = Boards(1).classes();
    let objective =
        NmsObjective { params: &params, classes, sizes, least_overlap: 0.5, positive_weight: 2.0 };
    let samples = (0..4).map(|index| Boards(4).get(index).unwrap()).collect();
    let network = |device: &burn::tensor::Device| Seq2SeqNmsNetwork::new(&sizes, device);
    let [before, after] = losses_on_one_batch(&objective, network, samples, 0.001);
    // Labels of 0.02 and 0.98 have a minimum loss of 0.098.
    assert!(after < 0.3 * before && after < 0.15, "{before} {after}");
}

#[test]
fn duplicates_and_false_detections_are_suppressed() {
    let folder = scratch("boards");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
    let statistics = trained(None, 24, &fit_params(60, 0.002), &job).unwrap();
    let losses = &statistics.curves["loss"];
    assert!(losses[losses.len() - 1] < 0.5 * losses[0], "{losses:?}");
    let mut learner = loaded(&job, 0.5);
    // Boards outside the training set.
    let (mut right, mut kept) = (0, 0);
    for index in 100..110 {
        let (image, detections, ground_truth) = boards(index);
        let found = learner.infer(Seq2SeqNmsInputs { image: &image, detections: &detections }).unwrap();
        kept += found.boxes.len();
        right += ground_truth
            .boxes
            .iter()
            .filter(|board| found.boxes.iter().any(|found| iou(&found.corners(), &board.corners()) > 0.5))
            .count();
        assert!(found.boxes.windows(2).all(|pair| pair[0].confidence >= pair[1].confidence));
    }
    assert!(right >= 16 && kept <= 24, "{right} of 20 detected, {kept} boxes kept of 120");
    let calls = (0..3).map(|index| Boards(3).get(index).unwrap().data).collect();
    check_trained_learner::<Seq2SeqNms>(&job.model(), &folder.join("promises"), calls);
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn an_untrained_network_changes_nothing_and_training_resumes() {
    let folder = scratch("still");
    let [first, second] = ["first", "second"]
        .map(|name| folder.join(name))
        .map(|output| FitJob { device: Device::Cpu, ..FitJob::new(Box::leak(output.into_boxed_path())) });
    trained(None, 2, &fit_params(1, 0.0), &first).unwrap();
    let (image, detections, _) = boards(0);
    let mut learner = loaded(&first, 0.0);
    let found = learner.infer(Seq2SeqNmsInputs { image: &image, detections: &detections }).unwrap();
    assert!(found.boxes.len() > 2);
    for found in &found.boxes {
        let same = detections.boxes.iter().any(|before| {
            before.corners() == found.corners() && (before.confidence - found.confidence).abs() < 1e-4
        });
        assert!(same, "{found}");
    }
    // A further training keeps the variant of its model.
    let base = Model::open(first.model()).unwrap();
    let other = Seq2SeqNmsFitParams { variant: NmsVariant::Full, ..fit_params(1, 0.0) };
    trained(Some(&base), 2, &other, &second).unwrap();
    let again =
        loaded(&second, 0.0).infer(Seq2SeqNmsInputs { image: &image, detections: &detections }).unwrap();
    assert_eq!(again, found);
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn invalid_detections_are_handled() {
    let folder = scratch("hostile");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
    trained(None, 2, &fit_params(1, 0.0), &job).unwrap();
    let mut learner = loaded(&job, 0.0);
    let (image, ..) = boards(0);
    let mut kept = |boxes: Vec<BoundingBox>, classes: &[&str]| {
        let classes = classes.iter().copied().collect();
        let detections = BoundingBoxList { classes, ..boxes.into() };
        learner.infer(Seq2SeqNmsInputs { image: &image, detections: &detections }).unwrap().boxes.len()
    };
    assert_eq!(kept(Vec::new(), &[]), 0);
    let nonsense = [f32::NAN, f32::INFINITY, -10.0, 0.0, 1e30]
        .map(|side| BoundingBox::new(0, 1.0, 1.0, side, 20.0, 0.9));
    assert!(kept(nonsense.into(), &[]) <= 1);
    let scores =
        [f32::NAN, f32::INFINITY, -1.0].map(|score| BoundingBox::new(0, 1.0, 1.0, 20.0, 20.0, score));
    assert_eq!(kept(scores.into(), &[]), 0);
    let one = |name: i64| vec![BoundingBox::new(name, 1.0, 1.0, 20.0, 20.0, 0.9)];
    assert_eq!((kept(one(0), &[]), kept(one(7), &[])), (1, 0));
    assert_eq!((kept(one(0), &["cat", "board"]), kept(one(1), &["cat", "board"])), (0, 1));
    let many = (0..3000)
        .map(|at| BoundingBox::new(0, (at % 60) as f32 * 300.0, (at / 60) as f32 * 50.0, 20.0, 20.0, 0.9));
    assert_eq!(kept(many.collect(), &[]), 400);
    let boxes = BoundingBoxList::default();
    let grey = Image::from_rgb8(vec![9; 3], 1, 1).unwrap();
    assert!(learner.infer(Seq2SeqNmsInputs { image: &grey, detections: &boxes }).is_ok());
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn samples_without_candidates_are_refused() {
    struct Plain;
    impl Dataset for Plain {}
    impl DatasetIterator for Plain {
        fn len(&self) -> usize {
            2
        }

        fn get(&self, index: usize) -> Result<Sample> {
            let (image, _, ground_truth) = boards(index);
            Ok(Sample { data: vec![Value::from(image)], target: Some(ground_truth.into()) })
        }

        fn classes(&self) -> Classes {
            Boards(1).classes()
        }
    }
    let folder = scratch("plain");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
    let fit = |fit_params: &Seq2SeqNmsFitParams| {
        let dataset = DatasetRef::from(&Plain as &dyn DatasetIterator);
        Seq2SeqNms::fit(None, &Seq2SeqNmsParams::default(), fit_params, dataset, None, &job).unwrap_err()
    };
    let error = fit(&fit_params(1, 0.001));
    assert_eq!(error.kind(), ErrorKind::InvalidInput);
    assert!(error.to_string().contains("`detector`"), "{error}");
    let unknown = Seq2SeqNmsFitParams { classes: vec!["cat".to_owned()], ..fit_params(1, 0.001) };
    assert!(fit(&unknown).to_string().contains("board"));
    std::fs::remove_dir_all(folder).ok();
}
