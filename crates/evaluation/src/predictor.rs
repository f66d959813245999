//! Predictions for the samples of a data set, in parallel and in order.

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::learner::{AnyLearner, AnyStream, Outputs, Port, Ports};
use opendr_engine::target::{
    BoundingBox3DList, BoundingBoxList, PoseList, TrackingAnnotation3DList, TrackingAnnotationList,
};
use opendr_engine::{Error, Progress, Result, Value, ValueRef, ValueType, map_in_order};

use crate::journal::{Line, SampleResult};

/// Anything that predicts samples: a learner, a stream of one, or a pipeline.
pub trait Predictor: Send {
    /// Resets the state, before another sequence.
    fn reset(&mut self);

    /// Predicts from one set of named inputs.
    ///
    /// # Errors
    /// The errors of the learner.
    fn infer(&mut self, ports: &Ports<'_>) -> Result<Outputs>;
}

impl Predictor for Box<dyn AnyLearner> {
    fn reset(&mut self) {
        (**self).reset();
    }

    fn infer(&mut self, ports: &Ports<'_>) -> Result<Outputs> {
        (**self).infer(ports)
    }
}

impl Predictor for Box<dyn AnyStream> {
    fn reset(&mut self) {
        (**self).reset();
    }

    fn infer(&mut self, ports: &Ports<'_>) -> Result<Outputs> {
        (**self).infer(ports)
    }
}

/// A sample with the outputs of a learner.
#[derive(Debug, Clone, Copy)]
pub struct PredictedSample<'a> {
    /// Index in the data set.
    pub index: usize,
    /// Name for reports.
    pub name: &'a str,
    /// Value of the learner's first port.
    pub input: ValueRef<'a>,
    /// Outputs by name.
    pub outputs: &'a Outputs,
}

/// Receives samples on the thread that predicted them.
pub type SampleObserver<'a> = dyn Fn(PredictedSample<'_>) + Sync + 'a;

/// The samples of a data set that are predicted.
pub(crate) struct PredictionJob<'a> {
    pub ports: &'a [Port],
    pub dataset: &'a dyn DatasetIterator,
    /// Index of the first sample.
    pub first: usize,
    /// Type of the predictions that the metric compares.
    pub wanted: ValueType,
    pub observer: Option<&'a SampleObserver<'a>>,
}

impl PredictionJob<'_> {
    /// Predicts the samples, with as many in parallel as there are `predictors`; sequences run on the first only, with a reset between
    /// them. Each result is passed to `each`; the user may stop it.
    ///
    /// # Errors
    /// The errors of `each`.
    pub fn predict<P: Predictor>(
        &self,
        predictors: &mut [P],
        progress: &dyn Progress,
        mut each: impl FnMut(Line) -> Result<()>,
    ) -> Result<()> {
        let Self { dataset, first, .. } = *self;
        let in_sequences = dataset.len() > first && dataset.sequence(first).is_some();
        let at_once = if in_sequences { predictors.len().min(1) } else { predictors.len() };
        let indices = (first..dataset.len()).take_while(|_| !progress.stopped());
        let work = |predictor: &mut P, at: usize| {
            let begins = at == 0 || !in_sequences || dataset.sequence(at) != dataset.sequence(at - 1);
            if begins {
                predictor.reset();
            }
            (at, self.predict_sample(predictor, at))
        };
        map_in_order(&mut predictors[..at_once], indices, work, |(at, prediction)| {
            each(Line { at, name: dataset.name(at), result: SampleResult::of(prediction, dataset, at) })?;
            progress.advance(1);
            Ok(())
        })
    }

    /// Returns the prediction of the wanted type for one sample; else one of another type, which the metric may accept.
    fn predict_sample(&self, predictor: &mut impl Predictor, at: usize) -> Result<Value> {
        let sample = self.dataset.get(at)?;
        let ports = Ports::of_sample(self.ports, &sample.data);
        let outputs = predictor.infer(&ports)?;
        if let (Some(observer), Some(data)) = (self.observer, sample.data.first()) {
            let name = self.dataset.name(at);
            let input = data.as_value_ref();
            observer(PredictedSample { index: at, name: &name, input, outputs: &outputs });
        }
        let prediction = outputs.iter().find(|(_, value)| value.as_value_ref().value_type() == self.wanted);
        let prediction = prediction.or_else(|| outputs.iter().next()).map(|(_, value)| value.clone());
        // A learner after a detector without detections has no input.
        let prediction = prediction.or_else(|| empty_list(self.wanted));
        prediction.ok_or_else(|| Error::invalid_input("there is no prediction"))
    }
}

/// Returns an empty list of a type, if it is a list.
pub(crate) fn empty_list(wanted: ValueType) -> Option<Value> {
    match wanted {
        ValueType::BoundingBoxList => Some(BoundingBoxList::default().into()),
        ValueType::BoundingBox3DList => Some(BoundingBox3DList::default().into()),
        ValueType::PoseList => Some(PoseList::default().into()),
        ValueType::TrackingAnnotationList => Some(TrackingAnnotationList::default().into()),
        ValueType::TrackingAnnotation3DList => Some(TrackingAnnotation3DList::default().into()),
        _ => None,
    }
}
