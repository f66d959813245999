//! A small network from numbers in a row to the scores of classes.

use opendr_engine::model::Model;
use opendr_engine::{Device, Error, Result};
use opendr_inference::{Session, TensorView};

/// A session from `[1, numbers]` to logits `[1, classes]`.
pub(super) struct PointClassifier {
    session: Session,
    numbers: usize,
}

impl PointClassifier {
    /// Opens the container's network called `file`.
    pub fn open(model: &Model, file: &str, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(file)?, device)?;
        let ([input], [output]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{file} has not one input and one output")));
        };
        let (&[_, Some(numbers)], &[_, Some(_)]) = (&input.dims[..], &output.dims[..]) else {
            return Err(Error::format(format!(
                "{file} turns {input} into {output}, which are no numbers in a row and their scores"
            )));
        };
        Ok(Self { numbers, session })
    }

    /// How many numbers it takes.
    pub fn numbers(&self) -> usize {
        self.numbers
    }

    /// Shows the logits of `features` to `sink`.
    pub fn run(&self, features: &[f32], mut sink: impl FnMut(&[f32]) -> Result<()>) -> Result<()> {
        let input = TensorView::new(&[1, self.numbers], features)?;
        self.session.run(&[input], |outputs| sink(outputs.first().map_or(Ok(&[][..]), TensorView::values)?))
    }
}

/// Refuses numbers that are not as many as the network takes, or not finite.
pub(super) fn check_numbers(numbers: &[f32], wanted: usize) -> Result<()> {
    if numbers.len() != wanted {
        let count = numbers.len();
        return Err(Error::invalid_input(format!(
            "{count} numbers in a row; the network takes {wanted}: 2 for each joint or point"
        )));
    }
    match numbers.iter().position(|number| !number.is_finite()) {
        Some(at) => {
            Err(Error::invalid_input(format!("number {at} of the row is {}; give finite ones", numbers[at])))
        }
        None => Ok(()),
    }
}
