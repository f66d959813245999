//! What the trainings of learners that answer a category have in common.

use burn::nn::loss::CrossEntropyLossConfig;
use burn::tensor::{Device, Int, Tensor, TensorData};
use opendr_engine::dataset::{DatasetIterator, Sample};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, Value};

/// Inputs of one size, one after the other, each with its class.
#[derive(Debug, Default)]
pub struct LabelledBatch {
    inputs: Vec<f32>,
    classes: Vec<i64>,
}

impl LabelledBatch {
    /// Makes an empty batch, with room for `capacity` of `size` numbers.
    pub fn with_capacity(capacity: usize, size: usize) -> Self {
        Self { inputs: Vec::with_capacity(capacity * size), classes: Vec::with_capacity(capacity) }
    }

    /// Adds an input.
    pub fn push(&mut self, input: &[f32], class: i64) {
        self.inputs.extend_from_slice(input);
        self.classes.push(class);
    }

    /// Returns the inputs `[batch, rows, columns]`.
    pub fn inputs(&self, [rows, columns]: [usize; 2], device: &Device) -> Tensor<3> {
        let shape = [self.classes.len(), rows, columns];
        Tensor::from_data(TensorData::new(self.inputs.clone(), shape), device)
    }

    /// Returns the mean cross-entropy of logits `[batch, classes]`; with `weights`, one a class, the weighted mean.
    pub fn cross_entropy(&self, logits: Tensor<2>, weights: &[f32], device: &Device) -> Tensor<1> {
        let count = self.classes.len();
        let classes = Tensor::<1, Int>::from_data(TensorData::new(self.classes.clone(), [count]), device);
        let weights = (!weights.is_empty()).then(|| weights.to_vec());
        CrossEntropyLossConfig::new().with_weights(weights).init(device).forward(logits, classes)
    }
}

/// Returns the class of a sample, below `classes`.
///
/// # Errors
/// `InvalidInput` when it has none, or one that the network does not have.
pub fn class_of(sample: &Sample, classes: usize) -> Result<i64> {
    let class = match &sample.target {
        Some(Value::Category(category)) => category.class,
        _ => return Err(Error::invalid_input("the sample has no category to learn; give it one")),
    };
    match usize::try_from(class) {
        Ok(index) if index < classes => Ok(class),
        _ => Err(Error::invalid_input(format!(
            "the sample is of class {class}, the network has {classes}, from 0; mend the data, or train with more classes"
        ))),
    }
}

/// Returns the classes to train: `wanted`, called `parameter`, or as many as the data name or have.
///
/// # Errors
/// `InvalidInput` when the data name more classes than are wanted.
pub fn classes_to_train(
    dataset: &dyn DatasetIterator,
    wanted: Option<usize>,
    parameter: &str,
) -> Result<Classes> {
    let named = dataset.classes();
    let count = match wanted {
        Some(wanted) if wanted < named.len() => {
            return Err(Error::invalid_input(format!(
                "the data set has {} classes, {parameter} = {wanted}; give as many, or leave it out",
                named.len()
            )));
        }
        Some(wanted) => wanted,
        None if !named.is_empty() => named.len(),
        None => count_classes(dataset)?,
    };
    let name = |class: usize| {
        named.name(class as i64).map_or_else(|| format!("class {class}"), |name| name.to_string())
    };
    Ok((0..count).map(name).collect())
}

/// One more than the highest class that occurs.
fn count_classes(dataset: &dyn DatasetIterator) -> Result<usize> {
    let mut most = 0;
    for index in 0..dataset.len() {
        if let Some(Value::Category(category)) = dataset.target(index)? {
            most = most.max(category.class.saturating_add(1));
        }
    }
    match most {
        2..=MOST_CLASSES => Ok(most as usize),
        _ => Err(Error::invalid_input(format!(
            "the data set names no classes and its highest is {}; give 2 to {MOST_CLASSES} classes",
            most - 1
        ))),
    }
}

const MOST_CLASSES: i64 = 10_000;
