use std::path::{Path, PathBuf};

use burn::module::Module;
use burn::tensor::activation::softmax;
use burn::tensor::{Device as Trainer, Int, Tensor, TensorData};
use opendr_datasets::{OpenOptions, Problems, open};
use opendr_engine::dataset::{Dataset, DatasetIterator, ExternalDataset, Sample};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::{ErrorKind, Random};
use opendr_perception_testing::learner_checks::check_trained_learner;
use opendr_perception_testing::overfit::losses_on_one_batch;
use opendr_training::Objective;

use super::network::CoTransEncNetwork;
use super::objective::SequenceObjective;
use super::*;

const INPUTS: usize = 6;
const TOKENS: usize = 5;

fn params(
    num_layers: usize,
    positional_encoding_learned: bool,
    token_dims: Option<usize>,
) -> CoTransEncParams {
    CoTransEncParams {
        num_layers,
        token_dims,
        hidden_dims: 10,
        sequence_len: TOKENS,
        num_heads: 2,
        positional_encoding_learned,
        ..Default::default()
    }
}

fn all() -> [CoTransEncParams; 4] {
    [params(1, false, None), params(2, false, Some(8)), params(1, true, Some(4)), params(2, true, None)]
}

fn series(seed: u64, time: usize) -> Timeseries {
    let mut random = Random::new(seed);
    let numbers: Vec<f32> = (0..time * INPUTS).map(|_| random.normal() as f32).collect();
    Timeseries::new(numbers, [time, INPUTS]).unwrap()
}

/// Noise with unrelated classes.
struct Noise;

impl Dataset for Noise {}

impl DatasetIterator for Noise {
    fn len(&self) -> usize {
        12
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let target = Category::new(index as i64 % 3, None);
        // Longer and shorter than the sequence.
        Ok(Sample { data: vec![series(index as u64, 3 + index / 2).into()], target: Some(target.into()) })
    }

    fn classes(&self) -> Classes {
        ["sit", "stand", "walk"].into_iter().collect()
    }
}

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("opendr-co-trans-enc-{name}-{}", std::process::id()));
        std::fs::remove_dir_all(&path).ok();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

fn objective(params: &CoTransEncParams) -> SequenceObjective<'_> {
    SequenceObjective { params, inputs: INPUTS, classes: Noise.classes() }
}

fn network(params: &CoTransEncParams) -> CoTransEncNetwork {
    CoTransEncNetwork::new(params, INPUTS, 3, 0.0, &Trainer::flex()).unwrap()
}

fn loaded(params: &CoTransEncParams, network: &CoTransEncNetwork, folder: &Path) -> Handle<CoTransEnc> {
    objective(params).container(network).unwrap().write(folder).unwrap();
    let mut handle = Handle::<CoTransEnc>::new(CoTransEncParams::default(), Device::Cpu).unwrap();
    handle.load(folder).unwrap();
    handle
}

/// Probabilities of the sequence of the vectors up to `end` of a stream, whose first vector is repeated before it.
fn of_clip(network: &CoTransEncNetwork, whole: &Timeseries, end: usize) -> Vec<f32> {
    let device = Trainer::flex();
    let vector = |at: usize| &whole.as_slice()[at * INPUTS..][..INPUTS];
    let numbers: Vec<f32> =
        (end..end + TOKENS).flat_map(|at| vector(at.saturating_sub(TOKENS))).copied().collect();
    let sequence = Tensor::<3>::from_data(TensorData::new(numbers, [1, TOKENS, INPUTS]), &device);
    let first = Tensor::<2, Int>::from_data([[(end as i64 - 1) % (2 * TOKENS as i64 - 1)]], &device);
    softmax(network.forward(sequence, first), 1).into_data().try_to_vec().unwrap()
}

/// Checks that each prediction of a stream equals that of the clip that ends with the vector.
fn assert_equal(params: &CoTransEncParams, network: &CoTransEncNetwork, name: &str) {
    let folder = Folder::new(name);
    let mut handle = loaded(params, network, &folder.0);
    // More than two rounds of positions.
    let whole = series(9, 4 * TOKENS + 3);
    let mut seen = Vec::new();
    for end in 1..=whole.shape()[0] {
        let vector = &whole.as_slice()[(end - 1) * INPUTS..][..INPUTS];
        let step = handle.infer(&Timeseries::new(vector.to_vec(), [1, INPUTS]).unwrap()).unwrap();
        for (a, b) in step.probabilities.iter().zip(&of_clip(network, &whole, end)) {
            assert!((a - b).abs() < 1e-4, "{params:?} after {end} vectors: {a} {b}");
        }
        seen.push(step);
    }
    assert_ne!(seen[5].probabilities, seen[6].probabilities, "the prediction depends on the input");
    handle.reset();
    assert_eq!(&handle.infer(&whole).unwrap(), seen.last().unwrap(), "a stream in one piece");
}

#[test]
fn steps_equal_clips() {
    for (index, params) in all().iter().enumerate() {
        assert_equal(params, &network(params), &format!("equal-{index}"));
    }
}

#[test]
fn steps_equal_clips_where_one_token_gets_all_attention() {
    let params = params(2, false, Some(8));
    // Scores with a deviation of hundreds, whose exponentials overflow.
    let network = network(&params).map(&mut Scaled);
    assert_equal(&params, &network, "peaked");
}

/// Multiplies weights of linear maps, not those of normalisations.
struct Scaled;

impl burn::module::ModuleMapper for Scaled {
    fn map_float<const D: usize>(
        &mut self,
        param: burn::module::Param<Tensor<D>>,
    ) -> burn::module::Param<Tensor<D>> {
        if D == 2 { param.map(|tensor| tensor * 20.0) } else { param }
    }
}

#[test]
fn one_batch_is_overfitted() {
    for params in all() {
        let samples = (0..Noise.len()).map(|index| Noise.get(index).unwrap()).collect();
        let network = |device: &Trainer| CoTransEncNetwork::new(&params, INPUTS, 3, 0.0, device).unwrap();
        let [before, after] = losses_on_one_batch(&objective(&params), network, samples, 0.005);
        assert!(after < 0.1 * before, "{params:?}: {before} {after}");
    }
}

#[test]
fn streams_do_not_mix() {
    let (folder, params) = (Folder::new("streams"), params(2, false, Some(8)));
    let network = network(&params);
    let handle = loaded(&params, &network, &folder.0);
    let [one, other] = [series(1, 12), series(2, 12)];
    let [mut first, mut second] = [handle.stream().unwrap(), handle.stream().unwrap()];
    for end in 1..=12 {
        let vector = |whole: &Timeseries| {
            Timeseries::new(whole.as_slice()[(end - 1) * INPUTS..][..INPUTS].to_vec(), [1, INPUTS]).unwrap()
        };
        let step = first.infer(&vector(&one)).unwrap();
        second.infer(&vector(&other)).unwrap();
        for (a, b) in step.probabilities.iter().zip(&of_clip(&network, &one, end)) {
            assert!((a - b).abs() < 1e-4);
        }
    }
}

#[test]
fn a_data_set_of_the_ucr_archive_trains_and_the_learner_meets_the_contract() {
    let folder = Folder::new("ucr");
    std::fs::create_dir_all(&folder.0).unwrap();
    // Slow and fast waves of random phase, the class first.
    let mut random = Random::new(3);
    let mut line = |class: usize| {
        let (phase, speed) = (random.uniform(0.0, 6.0), [0.3, 1.2][class]);
        let numbers = (0..16).map(|at| (speed * at as f32 + phase).sin().to_string());
        std::iter::once(class.to_string()).chain(numbers).collect::<Vec<_>>().join("\t")
    };
    let lines: Vec<String> = (0..80).map(|index| line(index % 2)).collect();
    std::fs::write(folder.0.join("Waves_TRAIN.tsv"), lines[..60].join("\n")).unwrap();
    std::fs::write(folder.0.join("Waves_TEST.tsv"), lines[60..].join("\n")).unwrap();
    let part = |name: &str| {
        let path = folder.0.join(format!("Waves_{name}.tsv"));
        open(&ExternalDataset::new(path, "ucr"), &OpenOptions::default(), &Problems::strict()).unwrap()
    };
    let (training, test) = (part("TRAIN"), part("TEST"));
    let params = CoTransEncParams { sequence_len: 12, ..params(2, false, Some(16)) };
    let mut fit_params = CoTransEncFitParams { dropout: 0.0, ..Default::default() };
    let training_params = &mut fit_params.training;
    training_params.optimizer = opendr_training::OptimizerKind::Adam;
    (training_params.epochs, training_params.batch_size, training_params.lr) = (60, 20, 0.005);
    let output = folder.0.join("out");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&output) };
    let mut handle = Handle::<CoTransEnc>::new(params, Device::Cpu).unwrap();
    handle.fit(&fit_params, (&*training).into(), None, &job).unwrap();
    let right = (0..test.len()).filter(|index| {
        let sample = test.get(*index).unwrap();
        let (Some(opendr_engine::Value::Timeseries(series)), Some(opendr_engine::Value::Category(class))) =
            (sample.data.first(), &sample.target)
        else {
            panic!("no series")
        };
        handle.reset();
        handle.infer(series).unwrap().class == class.class
    });
    let right = right.count();
    assert!(right >= 18, "{right} of 20");
    let calls = (0..3).map(|index| test.get(index).unwrap().data).collect();
    check_trained_learner::<CoTransEnc>(&job.model(), &output.join("scratch"), calls);
}

#[test]
fn contradictions_are_refused() {
    let folder = Folder::new("refused");
    let fit = |params: CoTransEncParams| {
        let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder.0) };
        let mut handle = Handle::<CoTransEnc>::new(params, Device::Cpu).unwrap();
        let dataset: &dyn DatasetIterator = &Noise;
        handle.fit(&CoTransEncFitParams::default(), dataset.into(), None, &job).unwrap_err()
    };
    let error = fit(CoTransEncParams { num_heads: 4, ..params(1, false, None) });
    assert_eq!(error.kind(), ErrorKind::InvalidParam);
    assert!(error.to_string().contains("set token_dims"), "{error}");
    for params in [
        CoTransEncParams { num_heads: 3, ..params(1, false, Some(8)) },
        CoTransEncParams { input_dims: Some(7), ..params(1, false, None) },
    ] {
        assert_eq!(fit(params).kind(), ErrorKind::InvalidParam);
    }
    let own = params(1, false, Some(8));
    let model = folder.0.join("model");
    let mut handle = loaded(&own, &network(&own), &model);
    let wide = Timeseries::new(vec![0.0; 7], [1, 7]).unwrap();
    let missing = Timeseries::new(vec![f32::NAN; INPUTS], [1, INPUTS]).unwrap();
    for wrong in [&wide, &missing] {
        assert_eq!(handle.infer(wrong).unwrap_err().kind(), ErrorKind::InvalidInput);
    }
    for params in [
        CoTransEncParams { sequence_len: 9, ..Default::default() },
        CoTransEncParams { num_layers: 2, ..Default::default() },
        CoTransEncParams { num_classes: Some(4), ..Default::default() },
        CoTransEncParams { input_dims: Some(8), ..Default::default() },
    ] {
        let mut other = Handle::<CoTransEnc>::new(params, Device::Cpu).unwrap();
        assert_eq!(other.load(&model).unwrap_err().kind(), ErrorKind::InvalidParam);
    }
}

#[test]
fn defaults_are_those_of_opendr() {
    let params = CoTransEncParams::default();
    assert_eq!(
        (params.num_layers, params.hidden_dims, params.sequence_len, params.num_heads),
        (1, 1024, 64, 8)
    );
    assert!(!params.positional_encoding_learned);
    let CoTransEncFitParams { training, dropout } = CoTransEncFitParams::default();
    assert_eq!((training.epochs, training.batch_size, training.lr, training.seed), (10, 64, 0.01, 123));
    assert_eq!((training.weight_decay, dropout), (1e-4, 0.1));
}
