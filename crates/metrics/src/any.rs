//! Metrics without their types: what surfaces hold.

use std::any::Any;

use opendr_engine::params::{Field, ParamMap, Params};
use opendr_engine::target::Classes;
use opendr_engine::{Datum, Error, Result, ValueRef, ValueType};

use crate::{Metric, Report};

/// A [`Metric`] of any type.
pub trait AnyMetric: Send {
    /// As [`Metric::name_classes`].
    fn name_classes(&mut self, classes: &Classes);

    /// Returns a copy that has counted the same.
    fn boxed_clone(&self) -> Box<dyn AnyMetric>;

    /// As [`Metric::update`].
    ///
    /// # Errors
    /// `InvalidInput` for a value of another type than the metric's, else as [`Metric::update`].
    fn update(&mut self, at: usize, prediction: ValueRef<'_>, truth: ValueRef<'_>) -> Result<f64>;

    /// As [`Metric::end_sequence`].
    fn end_sequence(&mut self);

    /// As [`Metric::merge`].
    ///
    /// # Errors
    /// `InvalidInput` when `other` is another metric.
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

    fn update(&mut self, at: usize, prediction: ValueRef<'_>, truth: ValueRef<'_>) -> Result<f64> {
        let refused = |what: &str, wanted: ValueType, got: ValueRef<'_>| {
            let (wanted, got) = (wanted.name(), got.value_type().name());
            Error::invalid_input(format!("the {what} of {} is a {wanted}, not a {got}", M::NAME))
        };
        let prediction = M::prediction(prediction)
            .ok_or_else(|| refused("prediction", M::Prediction::TYPE, prediction))?;
        let truth = M::truth(truth).ok_or_else(|| refused("truth", M::Truth::TYPE, truth))?;
        self.0.update(at, &prediction, &truth)
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

/// One metric: its tables, and how to make one.
pub struct MetricEntry {
    /// As users write it.
    pub name: &'static str,
    /// In one line.
    pub about: &'static str,
    /// As [`Metric::NUMBERS`].
    pub numbers: &'static [(&'static str, &'static str)],
    /// As [`Metric::ERRORS`].
    pub errors: &'static [&'static str],
    /// Its parameters.
    pub params: &'static [Field],
    /// As [`Metric::RANKS`].
    pub ranks: bool,
    /// As [`Metric::SEGMENTS`].
    pub segments: bool,
    /// What learners answer.
    pub prediction: ValueType,
    /// What they should answer.
    pub truth: ValueType,
    make: fn(&ParamMap) -> Result<Box<dyn AnyMetric>>,
}

impl MetricEntry {
    /// The entry of a metric.
    pub(crate) const fn of<M: Metric>() -> Self {
        Self {
            name: M::NAME,
            about: M::ABOUT,
            numbers: M::NUMBERS,
            errors: M::ERRORS,
            params: M::Params::FIELDS,
            ranks: M::RANKS,
            segments: M::SEGMENTS,
            prediction: M::Prediction::TYPE,
            truth: M::Truth::TYPE,
            make: |params| Ok(Box::new(Typed(M::new(&M::Params::from_map(params)?)?))),
        }
    }

    /// Whether less is better of its number called `name`.
    pub fn is_error(&self, name: &str) -> bool {
        self.errors.contains(&name)
    }

    /// An accumulator that has counted nothing, with `params` over the defaults.
    ///
    /// # Errors
    /// `InvalidParam` for an unknown or wrong parameter.
    pub fn make(&self, params: &ParamMap) -> Result<Box<dyn AnyMetric>> {
        (self.make)(params)
    }
}
