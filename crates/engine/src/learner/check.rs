//! The test that every learner passes (after scikit-learn's `check_estimator`).

use std::path::Path;

use crate::learner::{AnyLearner, AnyStream, Entry, Outputs, Ports};
use crate::params::{ParamMap, ParamValue};
use crate::target::{BoundingBoxList, PoseList};
use crate::{Device, Error, ErrorKind, Header, Result, ResultExt, Value, ValueType};

/// What [`check_learner`] works with.
pub struct CheckOptions<'a> {
    /// A container of the learner.
    pub model: &'a Path,
    /// A folder that it may write to.
    pub scratch: &'a Path,
    /// Calls of one stream in order: for each, the values of the ports by name. At least two, and different.
    pub calls: &'a [Vec<(&'static str, Value)>],
}

/// Checks that a learner keeps every promise of the interface; the error names the first that it breaks.
///
/// Documented parameters with valid defaults; an empty learner that says what to do; wrong ports, types and parameters
/// refused; time stamp and frame carried; the same call, the same answer; save and load without a difference; `reset`
/// that really resets; streams that do not mix, in one thread or two.
///
/// # Errors
/// `Internal` for a broken promise, and whatever a call failed with.
pub fn check_learner(entry: &'static Entry, options: &CheckOptions<'_>) -> Result<()> {
    let check = Check { entry, options };
    let named = |what: &'static str| move || format!("check_learner {}: {what}", entry.spec.name);
    check.tables().context(named("tables"))?;
    check.empty().context(named("empty learner"))?;
    let mut learner = check.loaded(options.model).context(named("load"))?;
    check.refusals(learner.as_mut()).context(named("refusals"))?;
    let answers = check.answers(learner.stream()?.as_mut()).context(named("infer"))?;
    check.headers(&answers).context(named("header"))?;
    check.repeats(learner.as_mut(), &answers).context(named("reset"))?;
    check.streams(learner.as_ref(), &answers).context(named("streams"))?;
    check.round_trip(learner.as_ref(), &answers).context(named("save and load"))
}

fn must(holds: bool, promise: &str) -> Result<()> {
    if holds { Ok(()) } else { Err(Error::internal(promise)) }
}

fn refused(result: Result<Outputs>, kind: ErrorKind, what: &str) -> Result<()> {
    match result {
        Err(error) if error.kind() == kind => Ok(()),
        Err(error) => Err(Error::internal(format!("{what} is refused as {}, not {kind}", error.kind()))),
        Ok(_) => Err(Error::internal(format!("{what} is not refused"))),
    }
}

struct Check<'a> {
    entry: &'static Entry,
    options: &'a CheckOptions<'a>,
}

impl Check<'_> {
    fn tables(&self) -> Result<()> {
        let spec = &self.entry.spec;
        let snake = |text: &str| {
            !text.is_empty()
                && text.bytes().all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_')
        };
        must(snake(spec.name), "the name is snake_case")?;
        must(spec.class.ends_with("Learner"), "the class name ends with Learner")?;
        must(spec.about.ends_with('.'), "`about` is a sentence")?;
        for field in self.entry.params.iter().chain(self.entry.fit_params) {
            must(snake(field.name), "parameters are snake_case")?;
            must(field.doc.ends_with('.'), &format!("the documentation of {} is sentences", field.name))?;
            field.check(&field.default.value()).context(|| "default")?;
        }
        must(!self.entry.ports.is_empty(), "there is an input")?;
        must(!self.entry.outputs.is_empty(), "there is an output")
    }

    fn empty(&self) -> Result<()> {
        let mut learner = self.entry.make(&ParamMap::new(), Device::Cpu)?;
        must(!learner.is_ready(), "a new learner is empty")?;
        let Err(error) = learner.infer(&self.ports(0)) else {
            return Err(Error::internal("an empty learner answers"));
        };
        let text = error.to_string();
        let ways = ["download", "load", "fit"].iter().all(|way| text.contains(way));
        must(ways, "the error of an empty learner names download, load and fit")?;
        let unknown = ParamMap::from([("no_such_parameter".to_owned(), 1.0.into())]);
        match self.entry.make(&unknown, Device::Cpu) {
            Err(error) if error.kind() == ErrorKind::InvalidParam => Ok(()),
            _ => Err(Error::internal("an unknown parameter is not refused")),
        }
    }

    fn loaded(&self, model: &Path) -> Result<Box<dyn AnyLearner>> {
        let mut learner = self.entry.make(&ParamMap::new(), Device::Cpu)?;
        learner.load(model)?;
        must(learner.is_ready(), "a loaded learner is ready")?;
        Ok(learner)
    }

    fn refusals(&self, learner: &mut dyn AnyLearner) -> Result<()> {
        let first = &self.options.calls[0];
        refused(learner.infer(&Ports::default()), ErrorKind::InvalidInput, "no input")?;
        let extra = self.ports(0).with("no_such_port", first[0].1.as_value_ref());
        refused(learner.infer(&extra), ErrorKind::InvalidInput, "an unknown port")?;
        for port in self.entry.ports {
            let (boxes, poses) = (Value::from(BoundingBoxList::default()), Value::from(PoseList::default()));
            let wrong = if port.value_type == ValueType::BoundingBoxList { poses } else { boxes };
            let ports = first.iter().fold(Ports::default(), |ports, (name, value)| {
                ports.with(name, if *name == port.name { wrong.as_value_ref() } else { value.as_value_ref() })
            });
            refused(learner.infer(&ports), ErrorKind::InvalidInput, "a port of another type")?;
        }
        for field in self.entry.params {
            must(
                learner.set(field.name, ParamValue::List(vec![ParamValue::None])).is_err(),
                "a parameter of another type is refused",
            )?;
        }
        learner.reset();
        Ok(())
    }

    fn answers(&self, stream: &mut dyn AnyStream) -> Result<Vec<Outputs>> {
        (0..self.options.calls.len()).map(|call| stream.infer(&self.ports(call))).collect()
    }

    fn headers(&self, answers: &[Outputs]) -> Result<()> {
        for (call, outputs) in self.options.calls.iter().zip(answers) {
            let first = self.entry.ports.first().map_or("", |port| port.name);
            let given = call.iter().find(|(name, _)| *name == first).map(|(_, value)| value.header().clone());
            must(given != Some(Header::default()), "the check's inputs have a stamp")?;
            let carried = outputs.iter().all(|(_, value)| Some(value.header()) == given.as_ref());
            must(carried, "stamp and frame reach the targets")?;
        }
        Ok(())
    }

    fn repeats(&self, learner: &mut dyn AnyLearner, answers: &[Outputs]) -> Result<()> {
        for _ in 0..2 {
            learner.reset();
            for (call, answer) in answers.iter().enumerate() {
                must(
                    &learner.infer(&self.ports(call))? == answer,
                    "after reset the answers are those of a fresh stream",
                )?;
            }
        }
        Ok(())
    }

    fn streams(&self, learner: &dyn AnyLearner, answers: &[Outputs]) -> Result<()> {
        let (mut one, mut other) = (learner.stream()?, learner.stream()?);
        other.infer(&self.ports(0))?;
        for (call, answer) in answers.iter().enumerate() {
            must(&one.infer(&self.ports(call))? == answer, "two streams do not mix")?;
            other.infer(&self.ports(answers.len() - 1 - call))?;
        }
        let (mut one, mut other) = (learner.stream()?, learner.stream()?);
        let (first, second) = std::thread::scope(|scope| {
            let thread = scope.spawn(|| self.answers(one.as_mut()));
            (self.answers(other.as_mut()), thread.join())
        });
        let second = second.map_err(|_| Error::internal("a thread panicked"))??;
        must(first? == answers && second == answers, "two threads do not mix")
    }

    fn round_trip(&self, learner: &dyn AnyLearner, answers: &[Outputs]) -> Result<()> {
        let folder = self.options.scratch.join(self.entry.spec.name);
        learner.save(&folder)?;
        let again = self.loaded(&folder)?;
        must(again.params() == learner.params(), "parameters survive save and load")?;
        must(self.answers(again.stream()?.as_mut())? == answers, "answers survive save and load")
    }

    fn ports(&self, call: usize) -> Ports<'_> {
        let values = self.options.calls[call].iter();
        values.fold(Ports::default(), |ports, (name, value)| ports.with(name, value.as_value_ref()))
    }
}
