//! The trait of metrics.

use std::borrow::Cow;

use opendr_engine::params::Params;
use opendr_engine::target::Classes;
use opendr_engine::{Datum, Result, ValueRef};

use crate::Report;

/// A streaming accumulator over the samples of a data set.
///
/// `eval` and every surface use this trait. Cores that work on plain numbers are methods of the same type or functions of
/// the same file.
pub trait Metric: Clone + Send + Sized + 'static {
    /// Name, e.g. `"coco_detection"`.
    const NAME: &'static str;
    /// Description in one line, with the reference implementation that it equals.
    const ABOUT: &'static str;
    /// Keys of its numbers with descriptions; `<k>` in a key is a placeholder.
    const NUMBERS: &'static [(&'static str, &'static str)];
    /// Parameters.
    type Params: Params;
    /// Type of the predictions.
    type Prediction: Datum;
    /// Type of the ground truth.
    type GroundTruth: Datum;

    /// Keys of the numbers for which lower is better.
    const LOWER_IS_BETTER: &'static [&'static str] = &[];

    /// Whether predictions are ranked by score, so that the threshold of a learner would truncate the ranking.
    const IS_RANKING: bool = false;

    /// Whether labels of maps are those of segments: [`LABEL_DIVISOR`](crate::LABEL_DIVISOR) times the class index plus the
    /// index of the object.
    const SEGMENTS: bool = false;

    /// Creates an empty accumulator.
    ///
    /// # Errors
    /// Returns `InvalidParam` for parameters that contradict each other.
    fn new(params: &Self::Params) -> Result<Self>;

    /// Sets the class names of the data set, before the first sample. Ties of scores are then resolved by class names, so
    /// that the numbering of the classes does not change the result.
    fn name_classes(&mut self, _classes: &Classes) {}

    /// Adds the prediction for sample `at` of the data set and returns its quality, 0 (worst) to 1.
    ///
    /// Ties of scores are resolved by `at`, so that the result does not depend on the distribution of samples over threads.
    /// The frames of a sequence are passed in order to one accumulator.
    ///
    /// # Errors
    /// Returns `InvalidInput` for an invalid prediction or ground truth; nothing is counted then.
    fn update(
        &mut self,
        at: usize,
        prediction: &Self::Prediction,
        ground_truth: &Self::GroundTruth,
    ) -> Result<f64>;

    /// Ends a sequence (video, drive); the next frame belongs to another one.
    fn end_sequence(&mut self) {}

    /// Adds the counts of `other`, which has other samples and whole sequences.
    fn merge(&mut self, other: Self);

    /// Returns the result. More samples can be added afterwards.
    fn finish(&self) -> Report;

    /// Converts a value to a prediction; metrics that accept several types override it.
    fn prediction(value: ValueRef<'_>) -> Option<Cow<'_, Self::Prediction>> {
        Self::Prediction::from_value_ref(value).map(Cow::Borrowed)
    }

    /// Converts a value to ground truth; metrics that accept several types override it.
    fn ground_truth(value: ValueRef<'_>) -> Option<Cow<'_, Self::GroundTruth>> {
        Self::GroundTruth::from_value_ref(value).map(Cow::Borrowed)
    }
}
