//! Type-erased metrics, for the surfaces.

use std::any::Any;

use opendr_engine::params::{Field, ParamMap, Params};
use opendr_engine::target::Classes;
use opendr_engine::{Datum, Error, Result, ValueRef, ValueType};

use crate::{Metric, Report};

/// A [`Metric`] of any type.
pub trait AnyMetric: Send {
    /// As [`Metric::name_classes`].
    fn name_classes(&mut self, classes: &Classes);

    /// Returns a clone.
    fn boxed_clone(&self) -> Box<dyn AnyMetric>;

    /// As [`Metric::update`].
    ///
    /// # Errors
    /// Returns `InvalidInput` for a value of another type than that of the metric; otherwise as [`Metric::update`].
    fn update(&mut self, at: usize, prediction: ValueRef<'_>, ground_truth: ValueRef<'_>) -> Result<f64>;

    /// As [`Metric::end_sequence`].
    fn end_sequence(&mut self);

    /// As [`Metric::merge`].
    ///
    /// # Errors
    /// Returns `InvalidInput` if `other` is another metric.
    fn merge(&mut self, other: Box<dyn AnyMetric>) -> Result<()>;

    /// As [`Metric::finish`].
    fn finish(&self) -> Report;

    #[doc(hidden)]
    fn into_any(self: Box<Self>) -> Box<dyn Any>;
}

struct Typed<M>(M);

impl<M: Metric> AnyMetric for Typed<M> {
    fn name_classes(&mut self, classes: &Classes) {
        self.0.name_classes(classes);
    }

    fn boxed_clone(&self) -> Box<dyn AnyMetric> {
        Box::new(Self(self.0.clone()))
    }

    fn update(&mut self, at: usize, prediction: ValueRef<'_>, ground_truth: ValueRef<'_>) -> Result<f64> {
        let invalid = |what: &str, expected: ValueType, given: ValueRef<'_>| {
            let (expected, given) = (expected.name(), given.value_type().name());
            Error::invalid_input(format!("the {what} of {} must be a {expected}, not a {given}", M::NAME))
        };
        let prediction = M::prediction(prediction)
            .ok_or_else(|| invalid("prediction", M::Prediction::TYPE, prediction))?;
        let ground_truth = M::ground_truth(ground_truth)
            .ok_or_else(|| invalid("ground truth", M::GroundTruth::TYPE, ground_truth))?;
        self.0.update(at, &prediction, &ground_truth)
    }

    fn end_sequence(&mut self) {
        self.0.end_sequence();
    }

    fn merge(&mut self, other: Box<dyn AnyMetric>) -> Result<()> {
        let other = other
            .into_any()
            .downcast::<M>()
            .map_err(|_| Error::invalid_input(format!("{} merges only with another {}", M::NAME, M::NAME)))?;
        self.0.merge(*other);
        Ok(())
    }

    fn finish(&self) -> Report {
        self.0.finish()
    }

    fn into_any(self: Box<Self>) -> Box<dyn Any> {
        Box::new(self.0)
    }
}

/// A metric: its tables and its constructor.
pub struct MetricEntry {
    /// Name, e.g. `"coco_detection"`.
    pub name: &'static str,
    /// Description in one line.
    pub about: &'static str,
    /// As [`Metric::NUMBERS`].
    pub numbers: &'static [(&'static str, &'static str)],
    /// As [`Metric::LOWER_IS_BETTER`].
    pub lower_is_better: &'static [&'static str],
    /// Parameters.
    pub params: &'static [Field],
    /// As [`Metric::IS_RANKING`].
    pub is_ranking: bool,
    /// As [`Metric::SEGMENTS`].
    pub segments: bool,
    /// Type of the predictions.
    pub prediction: ValueType,
    /// Type of the ground truth.
    pub ground_truth: ValueType,
    make: fn(&ParamMap) -> Result<Box<dyn AnyMetric>>,
}

impl MetricEntry {
    /// Creates the entry of a metric.
    pub(crate) const fn of<M: Metric>() -> Self {
        Self {
            name: M::NAME,
            about: M::ABOUT,
            numbers: M::NUMBERS,
            lower_is_better: M::LOWER_IS_BETTER,
            params: M::Params::FIELDS,
            is_ranking: M::IS_RANKING,
            segments: M::SEGMENTS,
            prediction: M::Prediction::TYPE,
            ground_truth: M::GroundTruth::TYPE,
            make: |params| Ok(Box::new(Typed(M::new(&M::Params::from_map(params)?)?))),
        }
    }

    /// Returns whether lower values of the number `name` are better.
    pub fn is_lower_better(&self, name: &str) -> bool {
        self.lower_is_better.contains(&name)
    }

    /// Creates an empty accumulator; `params` override the defaults.
    ///
    /// # Errors
    /// Returns `InvalidParam` for an unknown parameter or an invalid value.
    pub fn make(&self, params: &ParamMap) -> Result<Box<dyn AnyMetric>> {
        (self.make)(params)
    }
}
