mod architectures;
mod growth;

use std::path::{Path, PathBuf};

use burn::tensor::Device as Trainer;
use opendr_datasets::{OpenOptions, Problems, open};
use opendr_engine::data::SkeletonSequence;
use opendr_engine::dataset::{Dataset, DatasetIterator, ExternalDataset, Sample};
use opendr_engine::learner::{CheckOptions, Entry, FitJob, Handle, Learner, Probe, Stream, check_learner};
use opendr_engine::model::{Manifest, Model, ModelWriter};
use opendr_engine::params::{ParamMap, Params};
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, ErrorKind, Header, Random, Result, Value};
use opendr_perception_testing::overfit::losses_on_one_batch;
use opendr_training::Objective;

use super::network::ActionNetwork;
use super::objective::{ActionObjective, Form};
use super::sizes::NetworkSizes;
use super::*;

const JOINTS: usize = 15;

fn sizes() -> NetworkSizes {
    clip_params().sizes().unwrap()
}

fn clip() -> SkeletonClipParams {
    SkeletonClipParams {
        graph_type: GraphType::Jhmdb,
        in_channels: 2,
        num_frames: 20,
        temporal_kernel: 5,
        ..Default::default()
    }
}

fn clip_params() -> SpatioTemporalGcnParams {
    SpatioTemporalGcnParams { clip: clip(), channels: Some(vec![8, 12, 12]), ..Default::default() }
}

fn step_params() -> CoStGcnParams {
    CoStGcnParams {
        graph_type: GraphType::Jhmdb,
        in_channels: 2,
        sequence_len: 20,
        channels: vec![8, 12, 12],
        temporal_kernel: 5,
        ..Default::default()
    }
}

fn objective(form: Form) -> ActionObjective {
    let (learner, params) = match form {
        Form::Clip => (SpatioTemporalGcn::SPEC.name, clip_params().to_map()),
        Form::Step => (CoStGcn::SPEC.name, step_params().to_map()),
    };
    let (sizes, classes) = (sizes(), Walks.classes());
    ActionObjective { learner, sizes, form, params, classes, smoothing: 0.0, augment: false }
}

/// Persons whose joints move at random; some joints are missing.
fn walk(seed: u64, frames: usize, persons: usize) -> SkeletonSequence {
    let mut random = Random::new(seed);
    let mut numbers = vec![0.0; 2 * frames * JOINTS * persons];
    for person in 0..persons {
        for joint in 0..JOINTS {
            let mut place = [random.uniform(50.0, 250.0), random.uniform(50.0, 250.0)];
            for frame in 0..frames {
                place = place.map(|number| number + random.uniform(-5.0, 5.0));
                // The second person appears later.
                if random.chance(0.05) || frame < 7 * person {
                    continue;
                }
                for (channel, number) in place.into_iter().enumerate() {
                    numbers[((channel * frames + frame) * JOINTS + joint) * persons + person] = number;
                }
            }
        }
    }
    SkeletonSequence::new(numbers, [1, 2, frames, JOINTS, persons]).unwrap()
}

fn part(sequence: &SkeletonSequence, from: usize, to: usize) -> SkeletonSequence {
    let [_, channels, frames, joints, persons] = sequence.shape();
    let size = joints * persons;
    let numbers: Vec<f32> = (0..channels)
        .flat_map(|channel| {
            &sequence.as_slice()[(channel * frames + from) * size..(channel * frames + to) * size]
        })
        .copied()
        .collect();
    SkeletonSequence::new(numbers, [1, channels, to - from, joints, persons]).unwrap()
}

/// Random walks with unrelated classes.
struct Walks;

impl Dataset for Walks {}

impl DatasetIterator for Walks {
    fn len(&self) -> usize {
        9
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let sequence = walk(index as u64, 12 + 2 * index, 1);
        Ok(Sample {
            data: vec![Value::SkeletonSequence(sequence)],
            target: Some(Category::new(index as i64 % 3, None).into()),
        })
    }

    fn classes(&self) -> Classes {
        ["sit", "stand", "wave"].into_iter().collect()
    }
}

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("opendr-actions-{name}-{}", std::process::id()));
        std::fs::remove_dir_all(&path).ok();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

/// The same weights for clips and frame by frame.
fn both(folder: &Folder) -> (Handle<SpatioTemporalGcn>, Handle<CoStGcn>) {
    let device = Trainer::flex();
    device.seed(3);
    let network = ActionNetwork::new(&sizes(), 3, 0.0, &device).unwrap();
    let (clip, step) = (folder.0.join("clip"), folder.0.join("step"));
    objective(Form::Clip).container(&network).unwrap().write(&clip).unwrap();
    co_st_gcn_from(&Model::open(&clip).unwrap()).unwrap().write(&step).unwrap();
    load_both(&clip, &step)
}

fn load_both(clip: &Path, step: &Path) -> (Handle<SpatioTemporalGcn>, Handle<CoStGcn>) {
    let mut clip_wise = Handle::<SpatioTemporalGcn>::new(Default::default(), Device::Cpu).unwrap();
    clip_wise.load(clip).unwrap();
    let mut continual = Handle::<CoStGcn>::new(Default::default(), Device::Cpu).unwrap();
    continual.load(step).unwrap();
    (clip_wise, continual)
}

fn close(one: &Category, other: &Category, what: &str) {
    assert_eq!(one.probabilities.len(), other.probabilities.len());
    for (a, b) in one.probabilities.iter().zip(&other.probabilities) {
        assert!((a - b).abs() < 1e-4, "{what}: {a} {b}");
    }
}

/// Checks that every prediction of the stream equals the clip-wise prediction for all frames so far.
fn agree(clip_wise: &mut Handle<SpatioTemporalGcn>, stream: &mut Stream<CoStGcn>, whole: &SkeletonSequence) {
    for end in 1..=whole.shape()[2] {
        let step = stream.infer(&part(whole, end - 1, end)).unwrap();
        let clip = clip_wise.infer(&part(whole, 0, end)).unwrap();
        close(&step, &clip, &format!("after {end} frames"));
    }
}

/// Runs the registry's checks on a model with random weights.
fn check<L: Learner>(model: &Path, scratch: &Path, values: Vec<Value>) {
    let entry = Box::leak(Box::new(Entry::of::<L>(Probe::<L>::abilities(None, None, None, None))));
    let port = entry.ports[0].name;
    let calls = values.into_iter().zip(1..).map(|(mut value, stamp)| {
        *value.header_mut() = Header::new(stamp, "sensor");
        vec![(port, value)]
    });
    let calls: Vec<_> = calls.collect();
    check_learner(entry, &CheckOptions { model, scratch, calls: &calls }).unwrap();
}

#[test]
fn learners_meet_the_contract() {
    let folder = Folder::new("promises");
    both(&folder);
    let scratch = folder.0.join("scratch");
    let walks = || (0..3).map(|seed| Value::SkeletonSequence(walk(seed, 9, 2))).collect();
    check::<SpatioTemporalGcn>(&folder.0.join("clip"), &scratch, walks());
    check::<CoStGcn>(&folder.0.join("step"), &scratch, walks());
}

#[test]
fn overfits_one_batch() {
    let samples = (0..Walks.len()).map(|index| Walks.get(index).unwrap()).collect();
    let network = |device: &Trainer| ActionNetwork::new(&sizes(), 3, 0.0, device).unwrap();
    let [before, after] = losses_on_one_batch(&objective(Form::Clip), network, samples, 0.005);
    assert!(after < 0.05 * before, "{before} {after}");
}

#[test]
fn stream_predictions_equal_clip_predictions() {
    let folder = Folder::new("agree");
    let (mut clip_wise, mut continual) = both(&folder);
    for persons in [1, 2] {
        let whole = walk(5, 33, persons);
        let mut stream = continual.stream().unwrap();
        agree(&mut clip_wise, &mut stream, &whole);
        // A stream may be passed in pieces of any length.
        continual.reset();
        continual.infer(&part(&whole, 0, 9)).unwrap();
        let pieces = continual.infer(&part(&whole, 9, 33)).unwrap();
        close(&pieces, &clip_wise.infer(&whole).unwrap(), "in pieces");
    }
}

/// The models of the zoo with the same weights, clip by clip and frame by frame.
fn trained(folder: &Folder) -> Option<(Handle<SpatioTemporalGcn>, Handle<CoStGcn>)> {
    let weights = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../models/weights");
    if !weights.join("co_st_gcn").is_dir() {
        println!("skipped: no weights");
        return None;
    }
    let (channels, kernel) = (vec![32, 48, 64], 7);
    let clip = SpatioTemporalGcnParams {
        clip: SkeletonClipParams { num_frames: 32, temporal_kernel: kernel, ..clip() },
        channels: Some(channels.clone()),
        ..clip_params()
    };
    let step = CoStGcnParams { sequence_len: 32, channels, temporal_kernel: kernel, ..step_params() };
    let write = |learner: &str, params: ParamMap| {
        let network = std::fs::read(weights.join(learner).join("jhmdb.onnx")).unwrap();
        let mut manifest = Manifest::new(learner, "");
        manifest.params = params;
        let mut writer = ModelWriter::new(folder.0.join(learner), manifest).unwrap();
        writer.add("model.onnx", &network).unwrap();
        writer.finish().unwrap();
        folder.0.join(learner)
    };
    Some(load_both(&write("spatio_temporal_gcn", clip.to_map()), &write("co_st_gcn", step.to_map())))
}

#[test]
fn trained_weights_agree_too() {
    let folder = Folder::new("trained");
    let Some((mut clip_wise, continual)) = trained(&folder) else { return };
    agree(&mut clip_wise, &mut continual.stream().unwrap(), &walk(8, 90, 1));
}

#[test]
fn trained_weights_classify_held_out_recordings() {
    let Some(shared) = std::env::var_os("OPENDR_TEST_DATA") else {
        return println!("skipped: no OPENDR_TEST_DATA");
    };
    let path = Path::new(&shared).join("data/skeleton/jhmdb_GT_test_1.pkl");
    let test =
        open(&ExternalDataset::new(path, "jhmdb"), &OpenOptions::default(), &Problems::strict()).unwrap();
    let folder = Folder::new("floor");
    let Some((mut clip_wise, mut continual)) = trained(&folder) else { return };
    let mut right = [0, 0];
    for index in 0..test.len() {
        let sample = test.get(index).unwrap();
        let (Some(Value::SkeletonSequence(sequence)), Some(Value::Category(action))) =
            (sample.data.first(), &sample.target)
        else {
            panic!("sample {index} is no action")
        };
        let clip = clip_wise.infer(sequence).unwrap();
        continual.reset();
        let step = continual.infer(sequence).unwrap();
        close(&step, &clip, "of JHMDB");
        right[0] += usize::from(clip.class == action.class);
        right[1] += usize::from(step.class == action.class);
    }
    println!("correct of {}, clip-wise and frame by frame: {right:?}", test.len());
    assert!(right.iter().all(|right| right * 100 >= 60 * test.len()), "{right:?} of {}", test.len());
}

#[test]
fn streams_do_not_mix() {
    let folder = Folder::new("streams");
    let (mut clip_wise, continual) = both(&folder);
    let [one, other] = [walk(1, 25, 1), walk(2, 25, 1)];
    let [mut first, mut second] = [continual.stream().unwrap(), continual.stream().unwrap()];
    for frame in 0..25 {
        let step = first.infer(&part(&one, frame, frame + 1)).unwrap();
        second.infer(&part(&other, frame, frame + 1)).unwrap();
        close(&step, &clip_wise.infer(&part(&one, 0, frame + 1)).unwrap(), "two streams");
    }
}

#[test]
fn infer_loads_the_model_of_fit_and_training_resumes_from_it() {
    let folder = Folder::new("fit");
    let dataset: &dyn DatasetIterator = &Walks;
    let mut fit_params = SpatioTemporalGcnFitParams::default();
    (fit_params.training.epochs, fit_params.training.batch_size, fit_params.training.lr) = (1, 4, 0.01);
    let mut handle = Handle::<SpatioTemporalGcn>::new(clip_params(), Device::Cpu).unwrap();
    for round in ["first", "second"] {
        let output = folder.0.join(round);
        let job = FitJob { device: Device::Cpu, ..FitJob::new(&output) };
        let statistics = handle.fit(&fit_params, dataset.into(), Some(dataset.into()), &job).unwrap();
        assert_eq!(statistics.scalars["steps"], 2.0);
        assert_eq!(handle.infer(&walk(0, 12, 1)).unwrap().probabilities.len(), 3);
    }
    let mut fit_params = CoStGcnFitParams::default();
    (fit_params.training.epochs, fit_params.training.batch_size) = (1, 5);
    let mut handle = Handle::<CoStGcn>::new(step_params(), Device::Cpu).unwrap();
    let output = folder.0.join("step");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&output) };
    handle.fit(&fit_params, dataset.into(), None, &job).unwrap();
    assert_eq!(handle.infer(&walk(0, 1, 1)).unwrap().probabilities.len(), 3);
}

#[test]
fn invalid_models_and_inputs_are_refused() {
    let folder = Folder::new("refused");
    let (mut clip_wise, mut continual) = both(&folder);
    let nobody = SkeletonSequence::new(vec![0.0; 2 * 4 * JOINTS], [1, 2, 4, JOINTS, 1]).unwrap();
    let one_joint = SkeletonSequence::new(vec![1.0; 8], [1, 2, 4, 1, 1]).unwrap();
    let no_number = SkeletonSequence::new(vec![f32::NAN; 2 * JOINTS], [1, 2, 1, JOINTS, 1]).unwrap();
    for wrong in [&nobody, &one_joint, &no_number] {
        assert_eq!(clip_wise.infer(wrong).unwrap_err().kind(), ErrorKind::InvalidInput);
        assert_eq!(continual.infer(wrong).unwrap_err().kind(), ErrorKind::InvalidInput);
    }
    // The failed inputs leave the state unchanged.
    let fresh = continual.stream().unwrap().infer(&walk(1, 3, 1)).unwrap();
    assert_eq!(continual.infer(&walk(1, 3, 1)).unwrap(), fresh);
    let dataset: &dyn DatasetIterator = &Walks;
    let refused = |params: SpatioTemporalGcnParams| {
        let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder.0) };
        let mut handle = Handle::<SpatioTemporalGcn>::new(params, Device::Cpu).unwrap();
        handle.fit(&SpatioTemporalGcnFitParams::default(), dataset.into(), None, &job).unwrap_err().kind()
    };
    let with = |clip: SkeletonClipParams| SpatioTemporalGcnParams { clip, ..clip_params() };
    for params in [
        with(SkeletonClipParams { num_point: Some(25), ..clip() }),
        with(SkeletonClipParams { temporal_kernel: 4, ..clip() }),
        with(SkeletonClipParams { num_frames: 12, ..clip() }),
        SpatioTemporalGcnParams { channels: Some(Vec::new()), ..clip_params() },
    ] {
        assert_eq!(refused(params), ErrorKind::InvalidParam);
    }
    let other = SkeletonClipParams { num_class: Some(9), ..Default::default() };
    let other = SpatioTemporalGcnParams { clip: other, ..Default::default() };
    let mut handle = Handle::<SpatioTemporalGcn>::new(other, Device::Cpu).unwrap();
    assert_eq!(handle.load(folder.0.join("clip")).unwrap_err().kind(), ErrorKind::InvalidParam);
}

#[test]
fn defaults_are_those_of_opendr() {
    let params = SpatioTemporalGcnParams::default();
    assert_eq!((params.clip.num_person, params.clip.in_channels, params.clip.num_frames), (2, 3, 300));
    assert_eq!(
        (params.method_name, params.stbln_symmetric, params.num_subframes),
        (Method::StGcn, false, 100)
    );
    let growth = ProgressiveSpatioTemporalGcnParams::default().growth;
    assert_eq!((growth.blocksize, growth.num_blocks, growth.num_layers), (20, 10, 10));
    assert_eq!((growth.layer_threshold, growth.block_threshold, growth.topology.len()), (1e-4, 1e-4, 0));
    let training = SpatioTemporalGcnFitParams::default().training;
    assert_eq!(
        (training.epochs, training.batch_size, training.lr, training.lr_steps),
        (50, 128, 0.1, vec![30, 40])
    );
    let training = CoStGcnFitParams::default().training;
    assert_eq!((training.epochs, training.batch_size, training.lr, training.seed), (10, 64, 0.001, 123));
}
