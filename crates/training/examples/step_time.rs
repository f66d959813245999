//! Measures the time of a step of `fit` and the peak memory of the process, for benches/fit.py:
//! `step_time mobilenet|resnet18|gru|mlp STEPS` prints `{"ms": .., "peak_mb": ..}`.

use std::fs;
use std::process::exit;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use burn::module::Module;
use burn::nn::loss::CrossEntropyLossConfig;
use burn::nn::{Linear, LinearConfig};
use burn::tensor::activation::relu;
use burn::tensor::{Device, Int, Tensor, TensorData};
use opendr_datasets::loader::Collate;
use opendr_engine::data::Vector;
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::learner::FitJob;
use opendr_engine::model::Manifest;
use opendr_engine::{Device as Place, Error, Progress, Random, Result, Unit, Value};
use opendr_training::layers::{Gru, GruConfig, MobileNetV1, MobileNetV1Config, ResNet18, ResNet18Config};
use opendr_training::{
    Container, Loss, Objective, OptimizerKind, TrainingParams, fit_network, seeded_device,
};

const CLASSES: usize = 10;
/// Number of warm-up steps, which are not measured.
const WARM_UP: usize = 3;

/// The networks of the benchmark; benches/fit.py has the same in PyTorch.
#[derive(Module, Debug)]
#[allow(clippy::large_enum_variant)]
enum Network {
    MobileNet(Classified<MobileNetV1>),
    ResNet18(ResNet18),
    Gru(Classified<Gru>),
    Mlp(Mlp),
}

/// A network with a classification layer.
#[derive(Module, Debug)]
struct Classified<M: Module> {
    features: M,
    last: Linear,
}

#[derive(Module, Debug)]
struct Mlp {
    first: Linear,
    second: Linear,
    last: Linear,
}

/// A network with its name and the shape of its batch.
struct Case {
    name: &'static str,
    shape: &'static [usize],
    make: fn(&Device) -> Network,
}

const CASES: [Case; 4] = [
    Case {
        name: "mobilenet",
        shape: &[32, 3, 96, 96],
        make: |device| {
            let features = MobileNetV1Config::new().init(device);
            Network::MobileNet(Classified { features, last: LinearConfig::new(1024, CLASSES).init(device) })
        },
    },
    Case {
        name: "resnet18",
        shape: &[64, 3, 32, 32],
        make: |device| Network::ResNet18(ResNet18Config::new(CLASSES).with_small(true).init(device)),
    },
    Case {
        name: "gru",
        shape: &[32, 140, 1],
        make: |device| {
            let features = GruConfig::new(1, 128).init(device);
            Network::Gru(Classified { features, last: LinearConfig::new(128, CLASSES).init(device) })
        },
    },
    Case {
        name: "mlp",
        shape: &[64, 64],
        make: |device| {
            let layer = |outputs| LinearConfig::new(64, outputs).init(device);
            Network::Mlp(Mlp { first: layer(64), second: layer(64), last: layer(CLASSES) })
        },
    },
];

impl Network {
    fn forward(&self, numbers: TensorData, device: &Device) -> Tensor<2> {
        match self {
            Self::MobileNet(network) => {
                let maps = network.features.forward(Tensor::<4>::from_data(numbers, device));
                network.last.forward(maps.mean_dims(&[2, 3]).flatten(1, 3))
            }
            Self::ResNet18(network) => network.forward(Tensor::from_data(numbers, device)),
            Self::Gru(network) => {
                network.last.forward(network.features.last(Tensor::from_data(numbers, device)))
            }
            Self::Mlp(network) => {
                let hidden = relu(network.first.forward(Tensor::<2>::from_data(numbers, device)));
                network.last.forward(relu(network.second.forward(hidden)))
            }
        }
    }
}

/// A batch of random samples.
struct Noise<'a>(&'a [usize]);

impl Dataset for Noise<'_> {}

impl DatasetIterator for Noise<'_> {
    fn len(&self) -> usize {
        self.0[0]
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let mut random = Random::from_key([index as u64]);
        let numbers =
            (0..self.0[1..].iter().product()).map(|_| random.uniform(-1.0, 1.0)).collect::<Vec<_>>();
        Ok(Sample { data: vec![Vector::from_data(numbers)?.into()], target: None })
    }
}

/// Collates the values of the samples.
struct Numbers;

impl Collate for Numbers {
    type Batch = Vec<f32>;

    fn start(&self, _: usize) -> Vec<f32> {
        Vec::new()
    }

    fn add(&self, batch: &mut Vec<f32>, sample: Sample) -> Result<()> {
        if let Some(Value::Vector(numbers)) = sample.data.first() {
            batch.extend_from_slice(numbers.as_slice());
        }
        Ok(())
    }
}

struct Classify<'a>(&'a [usize]);

impl Objective for Classify<'_> {
    type Network = Network;
    type Collate = Numbers;

    fn collate(&self) -> Result<Numbers> {
        Ok(Numbers)
    }

    fn loss(&self, network: &Network, batch: &Vec<f32>, device: &Device) -> Result<Loss> {
        let count = batch.len() / self.0[1..].iter().product::<usize>();
        let shape: Vec<_> = [count].iter().chain(&self.0[1..]).copied().collect();
        let logits = network.forward(TensorData::new(batch.clone(), shape), device);
        let classes = Tensor::<1, Int>::arange(0..count as i64, device) % CLASSES as i64;
        Ok(CrossEntropyLossConfig::new().init(device).forward(logits, classes).into())
    }

    fn container(&self, _: &Network) -> Result<Container> {
        Ok(Container { manifest: Manifest::new("step_time", ""), files: Vec::new() })
    }
}

/// End of each step.
#[derive(Default)]
struct Steps(Mutex<Vec<Instant>>);

impl Progress for Steps {
    fn begin(&self, _: &str, _: Option<u64>, _: Unit) {}

    fn advance(&self, _: u64) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(Instant::now());
    }

    fn end(&self) {}
}

fn main() -> Result<()> {
    let mut words = std::env::args().skip(1);
    let name = words.next().unwrap_or_default();
    let (Some(case), Some(Ok(steps))) =
        (CASES.iter().find(|case| case.name == name), words.next().map(|word| word.parse::<usize>()))
    else {
        eprintln!("usage: step_time mobilenet|resnet18|gru|mlp STEPS");
        exit(2);
    };
    let output = std::env::temp_dir().join(format!("opendr-step-time-{}", std::process::id()));
    let times = Steps::default();
    let job = FitJob { progress: &times, device: Place::Cpu, ..FitJob::new(&output) };
    let params = TrainingParams {
        epochs: steps + WARM_UP + 1,
        batch_size: case.shape[0],
        optimizer: OptimizerKind::Sgd,
        lr: 0.01,
        momentum: 0.9,
        num_workers: 1,
        ..TrainingParams::default()
    };
    let network = (case.make)(&seeded_device(&job, &params)?);
    fit_network(&Classify(case.shape), network, &params, &Noise(case.shape), None, &job)?;
    fs::remove_dir_all(&output)?;
    let times = times.0.into_inner().unwrap_or_else(PoisonError::into_inner);
    let mut steps: Vec<_> =
        times.windows(2).map(|pair| (pair[1] - pair[0]).as_secs_f64() * 1e3).skip(WARM_UP).collect();
    steps.sort_by(f64::total_cmp);
    let median = steps.get(steps.len() / 2).ok_or_else(|| Error::internal("no steps"))?;
    println!("{{\"ms\": {median:.3}, \"peak_mb\": {:.1}}}", peak_mb()?);
    Ok(())
}

/// Returns the peak memory of the process in 10^6 bytes.
fn peak_mb() -> Result<f64> {
    let status = fs::read_to_string("/proc/self/status")?;
    let kilobytes = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix("kB"));
    let kilobytes: Option<f64> = kilobytes.and_then(|text| text.trim().parse().ok());
    kilobytes
        .map(|kilobytes| kilobytes * 1.024e-3)
        .ok_or_else(|| Error::unsupported("/proc/self/status has no VmHWM"))
}
