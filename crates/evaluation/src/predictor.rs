//! Predictions of the samples of a data set, several at once, in their order.

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::learner::{AnyLearner, AnyStream, Outputs, Port, Ports};
use opendr_engine::target::{
    BoundingBox3DList, BoundingBoxList, PoseList, TrackingAnnotation3DList, TrackingAnnotationList,
};
use opendr_engine::{Error, Progress, Result, Value, ValueType, map_in_order};

use crate::journal::{Answer, Line};

/// What predicts a sample: a learner, a stream of one, or several learners behind each other.
pub trait Predictor: Send {
    /// Forgets the samples before.
    fn reset(&mut self);

    /// Predicts one set of named inputs.
    ///
    /// # Errors
    /// Those of the learner.
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

/// Has the samples from `first` on predicted as `wanted`: as many at once as there are `predictors`, sequences by the first
/// alone, which forgets between them. Each prediction goes to `each`; the user may stop it.
///
/// # Errors
/// Those of `each`.
pub(crate) fn predict_samples<P: Predictor>(
    predictors: &mut [P],
    ports: &[Port],
    dataset: &dyn DatasetIterator,
    first: usize,
    wanted: ValueType,
    progress: &dyn Progress,
    mut each: impl FnMut(Line) -> Result<()>,
) -> Result<()> {
    let in_sequences = dataset.len() > first && dataset.sequence(first).is_some();
    let at_once = if in_sequences { predictors.len().min(1) } else { predictors.len() };
    let indices = (first..dataset.len()).take_while(|_| !progress.stopped());
    let work = |predictor: &mut P, at: usize| {
        let begins = at == 0 || !in_sequences || dataset.sequence(at) != dataset.sequence(at - 1);
        if begins {
            predictor.reset();
        }
        (at, predict_sample(predictor, ports, dataset, at, wanted))
    };
    map_in_order(&mut predictors[..at_once], indices, work, |(at, prediction)| {
        each(Line { at, name: dataset.name(at), answer: Answer::of(prediction, dataset, at) })?;
        progress.advance(1);
        Ok(())
    })
}

/// The prediction of the wanted type of one sample; of another type where there is none, which the metric may read.
fn predict_sample(
    predictor: &mut impl Predictor,
    ports: &[Port],
    dataset: &dyn DatasetIterator,
    at: usize,
    wanted: ValueType,
) -> Result<Value> {
    let sample = dataset.get(at)?;
    let outputs = predictor.infer(&Ports::of_sample(ports, &sample.data))?;
    let found = outputs.iter().find(|(_, value)| value.as_value_ref().value_type() == wanted);
    let found = found.or_else(|| outputs.iter().next()).map(|(_, value)| value.clone());
    // A learner behind a detector that found nothing has nothing to look at.
    found.or_else(|| nothing_of(wanted)).ok_or_else(|| Error::invalid_input("there is no prediction"))
}

/// A list of nothing.
pub(crate) fn nothing_of(wanted: ValueType) -> Option<Value> {
    match wanted {
        ValueType::BoundingBoxList => Some(BoundingBoxList::default().into()),
        ValueType::BoundingBox3DList => Some(BoundingBox3DList::default().into()),
        ValueType::PoseList => Some(PoseList::default().into()),
        ValueType::TrackingAnnotationList => Some(TrackingAnnotationList::default().into()),
        ValueType::TrackingAnnotation3DList => Some(TrackingAnnotation3DList::default().into()),
        _ => None,
    }
}
