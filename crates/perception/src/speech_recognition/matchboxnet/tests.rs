use burn::module::Module;
use burn::tensor::activation::softmax;
use burn::tensor::{Device as Trainer, Tensor, TensorData};
use opendr_engine::data::{Audio, Timeseries};
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::{Random, Value};
use opendr_training::Objective;

use super::network::{MatchboxNetNetwork, NetworkSizes};
use super::objective::SpeechObjective;
use super::*;
use crate::overfit::losses_on_one_batch;

const SIZES: NetworkSizes = NetworkSizes { blocks: 2, subblocks: 2, channels: 16, classes: 3, dropout: 0.0 };

/// Noise with classes that have nothing to do with it.
struct Noise;

impl Dataset for Noise {}

impl DatasetIterator for Noise {
    fn len(&self) -> usize {
        12
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let mut random = Random::new(index as u64);
        let samples: Vec<f32> = (0..16_000).map(|_| (0.1 * random.normal()) as f32).collect();
        // Sound comes in both forms.
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

#[test]
fn learns_one_batch_by_heart() {
    let params = MatchboxNetParams::default();
    let objective = SpeechObjective { params: &params, classes: Noise.classes(), augment: true };
    let samples = (0..Noise.len()).map(|index| Noise.get(index).unwrap()).collect();
    let network = |device: &Trainer| MatchboxNetNetwork::new(&SIZES, device);
    let [before, after] = losses_on_one_batch(&objective, network, samples, 0.005);
    assert!(after < 0.05 * before, "{before} {after}");
}

#[test]
fn infers_what_the_trainer_computes() {
    let device = Trainer::flex();
    device.seed(5);
    let network = MatchboxNetNetwork::new(&SIZES, &device);
    let params = MatchboxNetParams::default();
    let objective = SpeechObjective { params: &params, classes: Noise.classes(), augment: false };
    let folder = std::env::temp_dir().join(format!("opendr-matchboxnet-{}", std::process::id()));
    objective.container(&network).unwrap().write(&folder).unwrap();
    let mut handle = Handle::<MatchboxNet>::new(params.clone(), Device::Cpu).unwrap();
    handle.load(&folder).unwrap();
    let category = handle.infer((&audio(2)).into()).unwrap();
    let mut input = Vec::new();
    FrontEnd::new(true, 16_000).unwrap().input_into((&audio(2)).into(), &mut input).unwrap();
    let input = Tensor::<3>::from_data(TensorData::new(input, [1, COEFFICIENTS, FRAMES]), &device);
    let wanted = softmax(network.valid().forward(input), 1).into_data().try_to_vec::<f32>().unwrap();
    assert!(category.probabilities.iter().zip(&wanted).all(|(got, wanted)| (got - wanted).abs() < 1e-5));
    assert_eq!(category.description, Noise.classes().name(category.class).cloned());
    let series = Timeseries::new(audio(2).as_slice().to_vec(), [16_000, 1]).unwrap();
    assert_eq!(handle.infer((&series).into()).unwrap(), category);
    std::fs::remove_dir_all(&folder).ok();
}

#[test]
fn fit_makes_what_infer_loads_and_goes_on_from_it() {
    let output = std::env::temp_dir().join(format!("opendr-matchboxnet-fit-{}", std::process::id()));
    std::fs::remove_dir_all(&output).ok();
    let params = MatchboxNetParams { number_of_channels: 8, number_of_blocks: 1, ..Default::default() };
    let mut fit_params = MatchboxNetFitParams { dropout: 0.0, augment: false, ..Default::default() };
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
