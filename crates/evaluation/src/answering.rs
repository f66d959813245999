//! Whoever answers the samples of a data set, several at once, in their order.

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::learner::{AnyLearner, AnyStream, Outputs, Port, Ports};
use opendr_engine::{Error, Progress, Result, Value, ValueType, map_in_order};

use crate::journal::{Answer, Line};

/// A learner, or a stream of one.
pub trait Answering: Send {
    /// Forgets what it has seen.
    fn forget(&mut self);
    /// Answers named ports.
    fn answer(&mut self, ports: &Ports<'_>) -> Result<Outputs>;
}

impl Answering for Box<dyn AnyLearner> {
    fn forget(&mut self) {
        self.reset();
    }

    fn answer(&mut self, ports: &Ports<'_>) -> Result<Outputs> {
        self.infer(ports)
    }
}

impl Answering for Box<dyn AnyStream> {
    fn forget(&mut self) {
        self.reset();
    }

    fn answer(&mut self, ports: &Ports<'_>) -> Result<Outputs> {
        self.infer(ports)
    }
}

/// Has the samples from `first` on answered as `wanted`: as many at once as there are `workers`, sequences by the first
/// alone, which forgets between them. Each answer goes to `each`; the user may stop it.
///
/// # Errors
/// Those of `each`.
pub fn answer_samples<W: Answering>(
    workers: &mut [W],
    ports: &'static [Port],
    dataset: &dyn DatasetIterator,
    first: usize,
    wanted: ValueType,
    progress: &dyn Progress,
    mut each: impl FnMut(Line) -> Result<()>,
) -> Result<()> {
    let in_sequences = dataset.len() > first && dataset.sequence(first).is_some();
    let at_once = if in_sequences { workers.len().min(1) } else { workers.len() };
    let indices = (first..dataset.len()).take_while(|_| !progress.stopped());
    let work = |worker: &mut W, at: usize| {
        let begins = at == 0 || !in_sequences || dataset.sequence(at) != dataset.sequence(at - 1);
        if begins {
            worker.forget();
        }
        (at, answer_sample(worker, ports, dataset, at, wanted))
    };
    map_in_order(&mut workers[..at_once], indices, work, |(at, answer)| {
        each(Line { at, name: dataset.name(at), answer: Answer::of(answer, dataset, at) })?;
        progress.advance(1);
        Ok(())
    })
}

/// The answer of the wanted type to one sample.
fn answer_sample(
    worker: &mut impl Answering,
    ports: &'static [Port],
    dataset: &dyn DatasetIterator,
    at: usize,
    wanted: ValueType,
) -> Result<Value> {
    let sample = dataset.get(at)?;
    let outputs = worker.answer(&Ports::of_sample(ports, &sample.data))?;
    let found = outputs.iter().find(|(_, value)| value.as_value_ref().value_type() == wanted);
    let found = found.or_else(|| outputs.iter().next()).map(|(_, value)| value.clone());
    found.ok_or_else(|| Error::invalid_input("the learner answers nothing"))
}
