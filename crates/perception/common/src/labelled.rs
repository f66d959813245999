//! Batches and class lists for the training of classifiers.

use burn::nn::loss::CrossEntropyLossConfig;
use burn::tensor::{Device, Int, Tensor, TensorData};
use opendr_engine::dataset::{DatasetIterator, Sample};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, Value};

/// Inputs of one size, each with its class index.
#[derive(Debug, Default)]
pub struct LabelledBatch {
    inputs: Vec<f32>,
    classes: Vec<i64>,
}

impl LabelledBatch {
    /// Creates an empty batch with room for `capacity` inputs of `size` values.
    pub fn with_capacity(capacity: usize, size: usize) -> Self {
        Self { inputs: Vec::with_capacity(capacity * size), classes: Vec::with_capacity(capacity) }
    }

    /// Adds an input and its class index.
    pub fn push(&mut self, input: &[f32], class: i64) {
        self.inputs.extend_from_slice(input);
        self.classes.push(class);
    }

    /// Returns the inputs `[batch, rows, columns]`.
    pub fn inputs(&self, [rows, columns]: [usize; 2], device: &Device) -> Tensor<3> {
        let shape = [self.classes.len(), rows, columns];
        Tensor::from_data(TensorData::new(self.inputs.clone(), shape), device)
    }

    /// Returns the mean cross-entropy of logits `[batch, classes]`; with `weights`, one per class, the weighted mean.
    pub fn cross_entropy(&self, logits: Tensor<2>, weights: &[f32], device: &Device) -> Tensor<1> {
        let count = self.classes.len();
        let classes = Tensor::<1, Int>::from_data(TensorData::new(self.classes.clone(), [count]), device);
        let weights = (!weights.is_empty()).then(|| weights.to_vec());
        CrossEntropyLossConfig::new().with_weights(weights).init(device).forward(logits, classes)
    }
}

/// Returns the class index of a sample, which is below `classes`.
///
/// # Errors
/// `InvalidInput` when the sample has no class, or one that the network does not have.
pub fn class_of(sample: &Sample, classes: usize) -> Result<i64> {
    let class = match &sample.target {
        Some(Value::Category(category)) => category.class,
        _ => {
            return Err(Error::invalid_input("the sample has no category to train on; annotate it with one"));
        }
    };
    match usize::try_from(class) {
        Ok(index) if index < classes => Ok(class),
        _ => Err(Error::invalid_input(format!(
            "the sample has class {class}, but the network has {classes} classes, from 0; correct the data, or train with more classes"
        ))),
    }
}

/// Returns the classes to train. Their number is `wanted`, the value of the parameter `parameter`, else that of the data
/// set's names or of its highest class. Classes without a name are called `class N`.
///
/// # Errors
/// `InvalidInput` when the data set names more classes than `wanted`, or when its annotations give no usable number.
pub fn classes_to_train(
    dataset: &dyn DatasetIterator,
    wanted: Option<usize>,
    parameter: &str,
) -> Result<Classes> {
    let named = dataset.classes();
    let count = match wanted {
        Some(wanted) if wanted < named.len() => {
            return Err(Error::invalid_input(format!(
                "the data set has {} classes, but {parameter} = {wanted}; give at least as many, or omit {parameter}",
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

/// Returns one more than the highest class index of the data set.
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
            "the data set names no classes and its highest class is {}; give a data set of 2 to {MOST_CLASSES} classes",
            most - 1
        ))),
    }
}

/// Limit for a number of classes that is derived from annotations.
const MOST_CLASSES: i64 = 10_000;
