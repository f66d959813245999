//! What a metric is.

use std::borrow::Cow;

use opendr_engine::params::Params;
use opendr_engine::target::Classes;
use opendr_engine::{Datum, Result, ValueRef};

use crate::Report;

/// A streaming accumulator over the samples of a data set.
///
/// Cores that work on plain numbers stand beside it, as methods of the same type or as functions of the same file; this
/// trait is what `eval` and every surface drive.
pub trait Metric: Clone + Send + Sized + 'static {
    /// The name, as users write it, e.g. `"coco_detection"`.
    const NAME: &'static str;
    /// In one line, with the reference implementation that it equals.
    const ABOUT: &'static str;
    /// The names of its numbers and what they are; `<k>` in a name stands for something that varies.
    const NUMBERS: &'static [(&'static str, &'static str)];
    /// What a user may set.
    type Params: Params;
    /// What a learner answers.
    type Prediction: Datum;
    /// What it should answer.
    type Truth: Datum;

    /// Those of its numbers of which less is better.
    const ERRORS: &'static [&'static str] = &[];

    /// Whether answers are ranked by their scores, so that a learner's threshold would cut the ranking off.
    const RANKS: bool = false;

    /// Whether labels of maps are those of segments: [`LABEL_DIVISOR`](crate::LABEL_DIVISOR) times the class plus the number of the
    /// object.
    const SEGMENTS: bool = false;

    /// An accumulator that has counted nothing.
    ///
    /// # Errors
    /// `InvalidParam` for parameters that do not go together.
    fn new(params: &Self::Params) -> Result<Self>;

    /// Names the classes of the data set, before anything is counted. What depends on an order of classes (ties of scores) is
    /// then settled by their names, so that no numbering changes an outcome.
    fn name_classes(&mut self, _classes: &Classes) {}

    /// Counts the answer to sample number `at` of the data set, and tells how good it is: 0 (worst) to 1.
    ///
    /// Whatever depends on an order (ties of scores) is settled by `at`, so that the outcome does not depend on how
    /// samples are spread over threads. Frames of a sequence come one after the other to one accumulator.
    ///
    /// # Errors
    /// `InvalidInput` for an answer or a truth that cannot be counted; nothing has been counted then.
    fn update(&mut self, at: usize, prediction: &Self::Prediction, truth: &Self::Truth) -> Result<f64>;

    /// The sequence (video, drive) is over; what follows has nothing to do with it.
    fn end_sequence(&mut self) {}

    /// Counts what `other` counted: whole sequences, and other samples than this one's.
    fn merge(&mut self, other: Self);

    /// The outcome; counting may go on.
    fn finish(&self) -> Report;

    /// Reads a prediction; a metric that takes several types overrides it.
    fn prediction(value: ValueRef<'_>) -> Option<Cow<'_, Self::Prediction>> {
        Self::Prediction::from_value_ref(value).map(Cow::Borrowed)
    }

    /// Reads a truth; a metric that takes several types overrides it.
    fn truth(value: ValueRef<'_>) -> Option<Cow<'_, Self::Truth>> {
        Self::Truth::from_value_ref(value).map(Cow::Borrowed)
    }
}
