//! The conformance test of learners (after scikit-learn's `check_estimator`).

use std::path::Path;

use crate::learner::{AnyLearner, AnyStream, Entry, Outputs, Ports};
use crate::params::{ParamMap, ParamValue};
use crate::target::{BoundingBoxList, PoseList};
use crate::{Device, Error, ErrorKind, Header, Result, ResultExt, Value, ValueType};

/// Inputs of [`check_learner`].
pub struct CheckOptions<'a> {
    /// Path of a container of the learner.
    pub model: &'a Path,
    /// Folder for temporary files.
    pub scratch: &'a Path,
    /// Calls of one stream in order: for each, the values of the ports by name. At least two different ones.
    pub calls: &'a [Vec<(&'static str, Value)>],
}

/// Checks that a learner fulfils the contract of the interface; the error names the first violation.
///
/// It checks that parameters are documented and have valid defaults; that a learner without a model returns a helpful
/// error; that wrong ports, types and parameters are rejected; that time stamp and frame are kept; that equal calls give
/// equal predictions; that save and load change nothing; that `reset` resets; and that streams are independent, in one
/// thread or two.
///
/// # Errors
/// Returns `Internal` for a violation of the contract, and the error of a call that fails.
pub fn check_learner(entry: &'static Entry, options: &CheckOptions<'_>) -> Result<()> {
    let check = Check { entry, options };
    let named = |what: &'static str| move || format!("check_learner {}: {what}", entry.spec.name);
    check.tables().context(named("tables"))?;
    check.empty().context(named("empty learner"))?;
    let mut learner = check.loaded(options.model).context(named("load"))?;
    check.rejections(learner.as_mut()).context(named("rejections"))?;
    let predictions = check.predictions(learner.stream()?.as_mut()).context(named("infer"))?;
    check.headers(&predictions).context(named("header"))?;
    check.repeats(learner.as_mut(), &predictions).context(named("reset"))?;
    check.streams(learner.as_ref(), &predictions).context(named("streams"))?;
    check.round_trip(learner.as_ref(), &predictions).context(named("save and load"))
}

fn must(holds: bool, rule: &str) -> Result<()> {
    if holds { Ok(()) } else { Err(Error::internal(rule)) }
}

fn rejected(result: Result<Outputs>, kind: ErrorKind, what: &str) -> Result<()> {
    match result {
        Err(error) if error.kind() == kind => Ok(()),
        Err(error) => Err(Error::internal(format!("{what} is rejected as {}, not {kind}", error.kind()))),
        Ok(_) => Err(Error::internal(format!("{what} is not rejected"))),
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
        must(spec.about.ends_with('.'), "`about` ends with a full stop")?;
        for field in self.entry.params.iter().chain(self.entry.fit_params) {
            must(snake(field.name), "parameters are snake_case")?;
            must(
                field.doc.ends_with('.'),
                &format!("the documentation of {} ends with a full stop", field.name),
            )?;
            field.check(&field.default.value()).context(|| "default")?;
        }
        must(!self.entry.ports.is_empty(), "there is an input")?;
        must(!self.entry.outputs.is_empty(), "there is an output")
    }

    fn empty(&self) -> Result<()> {
        let mut learner = self.entry.make(&ParamMap::new(), Device::Cpu)?;
        must(!learner.is_ready(), "a new learner is empty")?;
        let Err(error) = learner.infer(&self.ports(0)) else {
            return Err(Error::internal("a learner without a model predicts"));
        };
        let text = error.to_string();
        let ways = ["download", "load", "fit"].iter().all(|way| text.contains(way));
        must(ways, "the error of an empty learner names download, load and fit")?;
        let unknown = ParamMap::from([("no_such_parameter".to_owned(), 1.0.into())]);
        match self.entry.make(&unknown, Device::Cpu) {
            Err(error) if error.kind() == ErrorKind::InvalidParam => Ok(()),
            _ => Err(Error::internal("an unknown parameter is not rejected")),
        }
    }

    fn loaded(&self, model: &Path) -> Result<Box<dyn AnyLearner>> {
        let mut learner = self.entry.make(&ParamMap::new(), Device::Cpu)?;
        learner.load(model)?;
        must(learner.is_ready(), "a loaded learner is ready")?;
        Ok(learner)
    }

    fn rejections(&self, learner: &mut dyn AnyLearner) -> Result<()> {
        let first = &self.options.calls[0];
        rejected(learner.infer(&Ports::default()), ErrorKind::InvalidInput, "no input")?;
        let extra = self.ports(0).with("no_such_port", first[0].1.as_value_ref());
        rejected(learner.infer(&extra), ErrorKind::InvalidInput, "an unknown port")?;
        for port in self.entry.ports {
            let (boxes, poses) = (Value::from(BoundingBoxList::default()), Value::from(PoseList::default()));
            let wrong = if port.value_type == ValueType::BoundingBoxList { poses } else { boxes };
            let others = first.iter().filter(|(name, _)| *name != port.name);
            let ports =
                others.fold(Ports::default(), |ports, (name, value)| ports.with(name, value.as_value_ref()));
            let ports = ports.with(port.name, wrong.as_value_ref());
            rejected(learner.infer(&ports), ErrorKind::InvalidInput, "a port of another type")?;
        }
        for field in self.entry.params {
            must(
                learner.set(field.name, ParamValue::List(vec![ParamValue::None])).is_err(),
                "a parameter of another type is rejected",
            )?;
        }
        learner.reset();
        Ok(())
    }

    fn predictions(&self, stream: &mut dyn AnyStream) -> Result<Vec<Outputs>> {
        (0..self.options.calls.len()).map(|call| stream.infer(&self.ports(call))).collect()
    }

    fn headers(&self, predictions: &[Outputs]) -> Result<()> {
        for (call, outputs) in self.options.calls.iter().zip(predictions) {
            let first = self.entry.ports.first().map_or("", |port| port.name);
            let given = call.iter().find(|(name, _)| *name == first).map(|(_, value)| value.header().clone());
            must(given != Some(Header::default()), "the check's inputs have a stamp")?;
            let is_kept = outputs.iter().all(|(_, value)| Some(value.header()) == given.as_ref());
            must(is_kept, "targets have the stamp and frame of the input")?;
        }
        Ok(())
    }

    fn repeats(&self, learner: &mut dyn AnyLearner, predictions: &[Outputs]) -> Result<()> {
        for _ in 0..2 {
            learner.reset();
            for (call, prediction) in predictions.iter().enumerate() {
                must(
                    &learner.infer(&self.ports(call))? == prediction,
                    "after reset the predictions are those of a new stream",
                )?;
            }
        }
        Ok(())
    }

    fn streams(&self, learner: &dyn AnyLearner, predictions: &[Outputs]) -> Result<()> {
        let (mut one, mut other) = (learner.stream()?, learner.stream()?);
        other.infer(&self.ports(0))?;
        for (call, prediction) in predictions.iter().enumerate() {
            must(&one.infer(&self.ports(call))? == prediction, "two streams are independent")?;
            // A learner whose frames are in the order of their stamps may refuse them backwards.
            let _ = other.infer(&self.ports(predictions.len() - 1 - call));
        }
        let (mut one, mut other) = (learner.stream()?, learner.stream()?);
        let (first, second) = std::thread::scope(|scope| {
            let thread = scope.spawn(|| self.predictions(one.as_mut()));
            (self.predictions(other.as_mut()), thread.join())
        });
        let second = second.map_err(|_| Error::internal("a thread panicked"))??;
        must(first? == predictions && second == predictions, "two threads are independent")
    }

    fn round_trip(&self, learner: &dyn AnyLearner, predictions: &[Outputs]) -> Result<()> {
        let folder = self.options.scratch.join(self.entry.spec.name);
        learner.save(&folder)?;
        let again = self.loaded(&folder)?;
        must(again.params() == learner.params(), "save and load keep the parameters")?;
        must(self.predictions(again.stream()?.as_mut())? == predictions, "save and load keep the predictions")
    }

    fn ports(&self, call: usize) -> Ports<'_> {
        let values = self.options.calls[call].iter();
        values.fold(Ports::default(), |ports, (name, value)| ports.with(name, value.as_value_ref()))
    }
}
