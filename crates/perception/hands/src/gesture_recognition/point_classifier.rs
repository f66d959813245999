//! A small classifier network for vectors.

use opendr_engine::model::Model;
use opendr_engine::{Device, Error, Result};
use opendr_inference::{Session, TensorView};

/// A session from `[1, numbers]` to logits `[1, classes]`.
pub(super) struct PointClassifier {
    session: Session,
    numbers: usize,
}

impl PointClassifier {
    /// Opens the container's network `file`.
    pub fn open(model: &Model, file: &str, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(file)?, device)?;
        let ([input], [output]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!(
                "{file} does not have one input and one output; train or download it again"
            )));
        };
        let (&[_, Some(numbers)], &[_, Some(_)]) = (&input.dims[..], &output.dims[..]) else {
            return Err(Error::format(format!(
                "{file} has the input {input} and the output {output} instead of a vector and scores; train or download it again"
            )));
        };
        Ok(Self { numbers, session })
    }

    /// Returns the number of input features.
    pub fn numbers(&self) -> usize {
        self.numbers
    }

    /// Computes the logits of `features` and passes them to `sink`.
    pub fn run(&self, features: &[f32], mut sink: impl FnMut(&[f32]) -> Result<()>) -> Result<()> {
        let input = TensorView::new(&[1, self.numbers], features)?;
        self.session.run(&[input], |outputs| sink(outputs.first().map_or(Ok(&[][..]), TensorView::values)?))
    }
}

/// Checks the number of values, and that they are finite.
pub(super) fn check_numbers(numbers: &[f32], expected: usize) -> Result<()> {
    if numbers.len() != expected {
        let count = numbers.len();
        return Err(Error::invalid_input(format!(
            "the vector has {count} values, the network takes {expected}; give 2 for each joint or point"
        )));
    }
    match numbers.iter().position(|number| !number.is_finite()) {
        Some(at) => Err(Error::invalid_input(format!(
            "value {at} of the vector is {}; give finite values",
            numbers[at]
        ))),
        None => Ok(()),
    }
}
