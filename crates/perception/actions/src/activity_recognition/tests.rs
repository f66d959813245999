use std::path::PathBuf;

use burn::tensor::Device as Trainer;
use opendr_engine::data::{Image, Video};
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, ErrorKind, Random, Result, Value};
use opendr_perception_testing::learner_checks::check_trained_learner;
use opendr_perception_testing::overfit::losses_on_one_batch;
use opendr_training::Objective;

use super::network::ActivityNetwork;
use super::objective::{ActivityObjective, Form};
use super::*;

const SIDE: usize = 32;
const FRAMES: usize = 4;

fn params() -> X3dParams {
    X3dParams {
        num_frames: Some(FRAMES),
        side: Some(SIDE),
        width: 0.34,
        depth: Some(0.4),
        ..Default::default()
    }
}

fn objective() -> ActivityObjective {
    ActivityObjective {
        sizes: Sizes::new(Backbone::S, Some(FRAMES), Some(SIDE), 0.34, Some(0.4)).unwrap(),
        form: Form::Clip,
        params: params().to_map(),
        classes: Clips.classes(),
        augment: false,
    }
}

/// Images of random `u8` levels.
fn pictures(seed: u64, frames: usize) -> Vec<Vec<u8>> {
    let mut random = Random::new(seed);
    (0..frames).map(|_| (0..SIDE * SIDE * 3).map(|_| random.below(256) as u8).collect()).collect()
}

fn video(pictures: &[Vec<u8>]) -> Video {
    let level = |channel: usize, picture: &Vec<u8>| {
        picture.iter().skip(channel).step_by(3).map(|level| f32::from(*level) / 255.0).collect::<Vec<_>>()
    };
    let levels: Vec<f32> =
        (0..3).flat_map(|channel| pictures.iter().flat_map(move |picture| level(channel, picture))).collect();
    Video::new(levels, [3, pictures.len(), SIDE, SIDE]).unwrap()
}

fn image(picture: &[u8]) -> Image {
    Image::from_rgb8(picture.to_vec(), SIDE, SIDE).unwrap()
}

/// Noise with unrelated classes.
struct Clips;

impl Dataset for Clips {}

impl DatasetIterator for Clips {
    fn len(&self) -> usize {
        6
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let video = video(&pictures(index as u64, FRAMES));
        Ok(Sample {
            data: vec![Value::Video(video)],
            target: Some(Category::new(index as i64 % 2, None).into()),
        })
    }

    fn classes(&self) -> Classes {
        ["sit", "wave"].into_iter().collect()
    }
}

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("opendr-activities-{name}-{}", std::process::id()));
        std::fs::remove_dir_all(&path).ok();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

fn both(folder: &Folder) -> (Handle<X3d>, Handle<CoX3d>) {
    let device = Trainer::flex();
    device.seed(3);
    let objective = objective();
    let network = ActivityNetwork::new(&objective.sizes, 2, 0.0, &device);
    let (clip, step) = (folder.0.join("clip"), folder.0.join("step"));
    objective.container(&network).unwrap().write(&clip).unwrap();
    co_x3d_from(&Model::open(&clip).unwrap()).unwrap().write(&step).unwrap();
    let mut clip_wise = Handle::<X3d>::new(Default::default(), Device::Cpu).unwrap();
    clip_wise.load(&clip).unwrap();
    let mut continual = Handle::<CoX3d>::new(Default::default(), Device::Cpu).unwrap();
    continual.load(&step).unwrap();
    (clip_wise, continual)
}

#[test]
fn learners_meet_the_contract() {
    let folder = Folder::new("promises");
    both(&folder);
    let scratch = folder.0.join("scratch");
    let clips = (0..3).map(|seed| vec![Value::Video(video(&pictures(seed, FRAMES)))]).collect();
    check_trained_learner::<X3d>(&folder.0.join("clip"), &scratch, clips);
    let pictures = (0..3).map(|seed| vec![Value::Image(image(&pictures(seed, 1)[0]))]).collect();
    check_trained_learner::<CoX3d>(&folder.0.join("step"), &scratch, pictures);
}

#[test]
fn overfits_one_batch() {
    let samples = (0..Clips.len()).map(|index| Clips.get(index).unwrap()).collect();
    let objective = objective();
    let network = |device: &Trainer| ActivityNetwork::new(&objective.sizes, 2, 0.0, device);
    let [before, after] = losses_on_one_batch(&objective, network, samples, 0.003);
    assert!(after < 0.05 * before, "{before} {after}");
}

#[test]
fn stream_predictions_equal_clip_predictions() {
    let folder = Folder::new("agree");
    let (mut clip_wise, mut continual) = both(&folder);
    let [one, other] = [pictures(1, FRAMES), pictures(2, FRAMES)];
    let mut second = continual.stream().unwrap();
    for round in 0..2 {
        let (mut last, mut last_of_other) = (Category::default(), Category::default());
        for (picture, another) in one.iter().zip(&other) {
            last = continual.infer(&image(picture)).unwrap();
            last_of_other = second.infer(&image(another)).unwrap();
        }
        for (step, pictures) in [(last, &one), (last_of_other, &other)] {
            let clip = clip_wise.infer(&video(pictures)).unwrap();
            assert_eq!((clip.class, &clip.description), (step.class, &step.description));
            for (a, b) in step.probabilities.iter().zip(&clip.probabilities) {
                assert!((a - b).abs() < 1e-4, "{round}: {a} {b}");
            }
        }
        continual.reset();
        second.reset();
    }
}

#[test]
fn one_frame_equals_a_clip_of_repeated_frames() {
    let folder = Folder::new("still");
    let (mut clip_wise, mut continual) = both(&folder);
    let picture = pictures(3, 1);
    let step = continual.infer(&image(&picture[0])).unwrap();
    let clip = clip_wise.infer(&video(&picture)).unwrap();
    assert!(step.probabilities.iter().zip(&clip.probabilities).all(|(a, b)| (a - b).abs() < 1e-4));
}

#[test]
fn infer_loads_the_model_of_fit() {
    let folder = Folder::new("fit");
    let dataset: &dyn DatasetIterator = &Clips;
    let mut fit_params = X3dFitParams::default();
    (fit_params.training.epochs, fit_params.training.batch_size) = (1, 3);
    let mut handle = Handle::<X3d>::new(params(), Device::Cpu).unwrap();
    let output = folder.0.join("clip");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&output) };
    let statistics = handle.fit(&fit_params, dataset.into(), Some(dataset.into()), &job).unwrap();
    assert_eq!(statistics.scalars["steps"], 2.0);
    assert_eq!(handle.infer(&video(&pictures(0, 9))).unwrap().probabilities.len(), 2);
    let grey = Video::new(vec![0.5; SIDE], [1, 1, 1, SIDE]).unwrap();
    assert_eq!(handle.infer(&grey).unwrap_err().kind(), ErrorKind::InvalidInput);
    let other = X3dParams { num_classes: Some(9), ..Default::default() };
    let mut handle = Handle::<X3d>::new(other, Device::Cpu).unwrap();
    let error = handle.load(FitJob::new(&output).model()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidParam);
}
