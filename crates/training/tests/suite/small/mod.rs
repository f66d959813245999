//! A small classification problem for the tests: points on two spirals.

use burn::module::{Module, ModuleVisitor, Param};
use burn::nn::loss::CrossEntropyLossConfig;
use burn::nn::{BatchNorm, BatchNormConfig, Dropout, DropoutConfig, Linear, LinearConfig};
use burn::tensor::activation::relu;
use burn::tensor::{Device, Int, Tensor, TensorData};
use opendr_datasets::loader::Collate;
use opendr_engine::data::Vector;
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::model::Manifest;
use opendr_engine::target::Category;
use opendr_engine::{Error, Random, Result, Value};
use opendr_training::{Container, Loss, Objective};

/// Points on two spirals.
pub struct Spirals {
    pub count: usize,
    /// Index of a point whose first coordinate is NaN.
    pub broken: Option<usize>,
}

impl Dataset for Spirals {}

impl DatasetIterator for Spirals {
    fn len(&self) -> usize {
        self.count
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let class = (index % 2) as i64;
        let mut random = Random::from_key([1, index as u64]);
        let turn = random.uniform(0.2, 1.0);
        let angle = turn * 6.0 + class as f32 * std::f32::consts::PI;
        let x = if self.broken == Some(index) { f32::NAN } else { turn * angle.cos() };
        let point = Vector::from_data(vec![x, turn * angle.sin()])?;
        Ok(Sample {
            data: vec![Value::Vector(point)],
            target: Some(Value::Category(Category::new(class, None))),
        })
    }

    fn name(&self, index: usize) -> String {
        format!("point {index}")
    }
}

#[derive(Module, Debug)]
pub struct Network {
    first: Linear,
    norm: BatchNorm,
    dropout: Dropout,
    second: Linear,
    third: Linear,
}

impl Network {
    pub fn new(device: &Device) -> Self {
        Self {
            first: LinearConfig::new(2, 32).init(device),
            norm: BatchNormConfig::new(32).init(device),
            dropout: DropoutConfig::new(0.05).init(),
            second: LinearConfig::new(32, 32).init(device),
            third: LinearConfig::new(32, 2).init(device),
        }
    }

    pub fn forward(&self, points: Tensor<2>) -> Tensor<2> {
        let hidden = self.dropout.forward(relu(self.norm.forward(self.first.forward(points))));
        self.third.forward(relu(self.second.forward(hidden)))
    }
}

/// Cross-entropy objective.
#[derive(Default)]
pub struct ClassifyPoints {
    /// Number of values held in memory per sample.
    pub ballast: usize,
}

pub struct Points;

#[derive(Default)]
pub struct Batch {
    points: Vec<f32>,
    classes: Vec<i64>,
}

impl Collate for Points {
    type Batch = Batch;

    fn start(&self, _: usize) -> Batch {
        Batch::default()
    }

    fn add(&self, batch: &mut Batch, sample: Sample) -> Result<()> {
        let (Some(Value::Vector(point)), Some(Value::Category(category))) =
            (sample.data.first(), &sample.target)
        else {
            return Err(Error::invalid_input("the sample has no point with a class"));
        };
        batch.points.extend(point.as_slice());
        batch.classes.push(category.class);
        Ok(())
    }
}

impl Objective for ClassifyPoints {
    type Network = Network;
    type Collate = Points;

    fn collate(&self) -> Result<Points> {
        Ok(Points)
    }

    fn loss(&self, network: &Network, batch: &Batch, device: &Device) -> Result<Loss> {
        let count = batch.classes.len();
        let points = Tensor::<2>::from_data(TensorData::new(batch.points.clone(), [count, 2]), device);
        let classes = Tensor::<1, Int>::from_data(TensorData::new(batch.classes.clone(), [count]), device);
        let ballast = Tensor::<2>::ones([count, self.ballast.max(1)], device).sum() * 0.0;
        let loss = CrossEntropyLossConfig::new().init(device);
        Ok((ballast + loss.forward(network.forward(points), classes)).into())
    }

    /// The raw weights: two networks are equal if their files are.
    fn container(&self, network: &Network) -> Result<Container> {
        let mut weights = Weights(Vec::new());
        network.visit(&mut weights);
        Ok(Container {
            manifest: Manifest::new("spirals", ""),
            files: vec![("weights.bin".to_owned(), weights.0)],
        })
    }
}

struct Weights(Vec<u8>);

impl ModuleVisitor for Weights {
    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        self.0.extend_from_slice(param.val().into_data().bytes());
    }
}
