use burn::module::Module;
use burn::tensor::activation::softmax;
use burn::tensor::{Device as Trainer, Tensor, TensorData};
use opendr_engine::data::{Audio, Timeseries};
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::{Random, Value};
use opendr_perception_testing::overfit::losses_on_one_batch;
use opendr_training::Objective;

use super::objective::WordObjective;
use super::*;
use crate::speech_recognition::{
    EdgeSpeechNet, EdgeSpeechNetsKind, EdgeSpeechNetsParams, MatchboxNet, MatchboxNetFitParams,
    MatchboxNetKind, MatchboxNetParams, QuadraticSelfOnnKind, QuadraticSelfOnnParams,
};

/// Small networks.
fn matchboxnet() -> MatchboxNetParams {
    MatchboxNetParams {
        number_of_blocks: 2,
        number_of_subblocks: 2,
        number_of_channels: 16,
        ..Default::default()
    }
}

fn edge_speech_nets(architecture: EdgeSpeechNet) -> EdgeSpeechNetsParams {
    EdgeSpeechNetsParams { architecture, ..Default::default() }
}

fn quadratic_self_onn() -> QuadraticSelfOnnParams {
    QuadraticSelfOnnParams { expansion_order: 2, ..Default::default() }
}

/// Noise with unrelated classes.
struct Noise;

impl Dataset for Noise {}

impl DatasetIterator for Noise {
    fn len(&self) -> usize {
        12
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let mut random = Random::new(index as u64);
        let samples: Vec<f32> = (0..16_000).map(|_| (0.1 * random.normal()) as f32).collect();
        // Audio in both of its types.
        let sound = match index % 2 {
            0 => Value::Audio(Audio::new(samples, 1, 16_000)?),
            _ => Value::Timeseries(Timeseries::new(samples, [16_000, 1])?),
        };
        Ok(Sample { data: vec![sound], target: Some(Category::new(index as i64 % 3, None).into()) })
    }

    fn classes(&self) -> Classes {
        ["yes", "no", "stop"].into_iter().collect()
    }
}

fn audio(index: usize) -> Audio {
    let Some(Value::Audio(audio)) = Noise.get(index).unwrap().data.into_iter().next() else { panic!() };
    audio
}

fn overfits<K: TrainableWords>(params: &K::Params, lr: f64) {
    let objective = WordObjective::<K> { params, classes: Noise.classes(), augment: true };
    let samples = (0..Noise.len()).map(|index| Noise.get(index).unwrap()).collect();
    let network = |device: &Trainer| K::network(params, 3, 0.0, device);
    let [before, after] = losses_on_one_batch(&objective, network, samples, lr);
    assert!(after < 0.05 * before, "{}: {before} {after}", K::SPEC.name);
}

#[test]
fn overfit_one_batch() {
    overfits::<MatchboxNetKind>(&matchboxnet(), 0.005);
    overfits::<EdgeSpeechNetsKind>(&edge_speech_nets(EdgeSpeechNet::D), 0.005);
    overfits::<QuadraticSelfOnnKind>(&quadratic_self_onn(), 0.003);
}

fn inference_equals_training_network<K: TrainableWords>(params: &K::Params) {
    let device = Trainer::flex();
    device.seed(5);
    let network = K::network(params, 3, 0.0, &device);
    let objective = WordObjective::<K> { params, classes: Noise.classes(), augment: false };
    let folder = std::env::temp_dir().join(format!("opendr-{}-{}", K::SPEC.name, std::process::id()));
    objective.container(&network).unwrap().write(&folder).unwrap();
    let mut handle = Handle::<WordLearner<K>>::new(params.clone(), Device::Cpu).unwrap();
    handle.load(&folder).unwrap();
    let category = handle.infer((&audio(2)).into()).unwrap();
    let mut input = Vec::new();
    FrontEnd::new(true, 16_000, K::COEFFICIENTS).unwrap().input_into((&audio(2)).into(), &mut input).unwrap();
    let input = Tensor::<3>::from_data(TensorData::new(input, [1, K::COEFFICIENTS, FRAMES]), &device);
    let expected = softmax(K::forward(&network.valid(), input), 1).into_data().try_to_vec::<f32>().unwrap();
    assert!(
        category.probabilities.iter().zip(&expected).all(|(got, expected)| (got - expected).abs() < 1e-5)
    );
    assert_eq!(category.description, Noise.classes().name(category.class).cloned());
    let series = Timeseries::new(audio(2).as_slice().to_vec(), [16_000, 1]).unwrap();
    assert_eq!(handle.infer((&series).into()).unwrap(), category);
    std::fs::remove_dir_all(&folder).ok();
}

#[test]
fn inference_equals_the_training_network() {
    inference_equals_training_network::<MatchboxNetKind>(&matchboxnet());
    for architecture in [EdgeSpeechNet::A, EdgeSpeechNet::B, EdgeSpeechNet::C, EdgeSpeechNet::D] {
        inference_equals_training_network::<EdgeSpeechNetsKind>(&edge_speech_nets(architecture));
    }
    inference_equals_training_network::<QuadraticSelfOnnKind>(&quadratic_self_onn());
}

#[test]
fn infer_loads_the_model_of_fit_and_training_resumes_from_it() {
    let output = std::env::temp_dir().join(format!("opendr-matchboxnet-fit-{}", std::process::id()));
    std::fs::remove_dir_all(&output).ok();
    let params = MatchboxNetParams { number_of_channels: 8, number_of_blocks: 1, ..Default::default() };
    let words = WordFitParams { dropout: 0.0, augment: false };
    let mut fit_params = MatchboxNetFitParams { words, ..Default::default() };
    (fit_params.training.epochs, fit_params.training.batch_size, fit_params.training.lr) = (1, 6, 0.003);
    let mut handle = Handle::<MatchboxNet>::new(params, Device::Cpu).unwrap();
    let dataset: &dyn DatasetIterator = &Noise;
    let mut losses = Vec::new();
    for round in ["first", "second"] {
        let folder = output.join(round);
        let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
        let statistics = handle.fit(&fit_params, dataset.into(), Some(dataset.into()), &job).unwrap();
        assert_eq!(statistics.scalars["steps"], 2.0);
        losses.extend_from_slice(&statistics.curves["loss"]);
        assert_eq!(handle.infer((&audio(0)).into()).unwrap().probabilities.len(), 3);
    }
    assert_eq!(losses.len(), 2);
    assert!(losses[1] < losses[0], "{losses:?}");
    std::fs::remove_dir_all(&output).ok();
}
