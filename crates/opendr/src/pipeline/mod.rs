//! Learners one after the other: a detector, a tracker, what looks at the tracks.

mod wiring;

use std::collections::BTreeMap;

use opendr_engine::learner::{AnyLearner, Entry, Output, Outputs, Port, Ports};
use opendr_engine::params::ParamMap;
use opendr_engine::{Device, Error, Progress, Result, Silent, assembly_line};

use crate::{learner_with, registry};
use wiring::{Wire, wires};

/// Learners that each take what those before them answer.
///
/// A port takes the newest answer of its type; what no learner before answers is an input of the pipeline, shared by all
/// that take it. So a detector, a tracker over `image` and `detections`, and a recogniser need no wiring by hand. The
/// answers of all are the answer of the pipeline; where two are of one type, the later one.
///
/// ```no_run
/// # fn main() -> opendr::Result<()> {
/// let mut pipeline = opendr::Pipeline::open("nanodet + posenet")?;
/// let image = opendr::vision::open("street.jpg")?;
/// println!("{:#}", pipeline.infer(&opendr::learner::Ports::one(&image))?);
/// # Ok(())
/// # }
/// ```
#[derive(Default)]
pub struct Pipeline {
    stages: Vec<Stage>,
    ports: Vec<Port>,
}

struct Stage {
    entry: &'static Entry,
    learner: Box<dyn AnyLearner>,
    wires: Vec<Wire>,
}

impl Pipeline {
    /// The learners that `specs` names, with their pretrained models: `"nanodet + yunet/320"`.
    ///
    /// # Errors
    /// As [`crate::learner()`] and [`Pipeline::then`].
    pub fn open(specs: &str) -> Result<Self> {
        Self::open_with(specs, Device::Auto, &Silent)
    }

    /// As [`Pipeline::open`], with a device and someone to tell how the downloads go.
    ///
    /// # Errors
    /// As [`Pipeline::open`].
    pub fn open_with(specs: &str, device: Device, progress: &dyn Progress) -> Result<Self> {
        let mut pipeline = Self::default();
        for spec in specs.split('+').map(str::trim) {
            let entry = registry().find(spec.split('/').next().unwrap_or(spec))?;
            pipeline = pipeline.then(entry, learner_with(spec, &ParamMap::new(), device, progress)?)?;
        }
        Ok(pipeline)
    }

    /// Adds a loaded learner of `entry` at the end.
    ///
    /// # Errors
    /// `InvalidParam` for one that takes nothing of what those before it answer.
    pub fn then(mut self, entry: &'static Entry, learner: Box<dyn AnyLearner>) -> Result<Self> {
        let answered = self.stages.iter().map(|stage| stage.entry.outputs).collect::<Vec<_>>();
        let wires = wires(entry.ports, &answered, &mut self.ports);
        let feeds = |wire: &Wire| matches!(wire, Wire::Answer { .. });
        let is_beside =
            entry.ports.iter().all(|port| self.stages.iter().any(|stage| takes(stage.entry, port)));
        if !self.stages.is_empty() && !wires.iter().any(feeds) && !is_beside {
            let wanted: Vec<_> = entry.ports.iter().map(|port| port.value_type.name()).collect();
            let there: Vec<_> = answered.iter().flat_map(|outputs| outputs.iter()).collect();
            let there: Vec<_> = there.iter().map(|output| output.value_type.name()).collect();
            return Err(Error::invalid_param(format!(
                "{} takes {}, and those before it answer {}; put one before it that answers what it takes",
                entry.spec.class,
                wanted.join(", "),
                there.join(", ")
            )));
        }
        self.stages.push(Stage { entry, learner, wires });
        Ok(self)
    }

    /// What it takes.
    pub fn ports(&self) -> &[Port] {
        &self.ports
    }

    /// What it answers.
    pub fn outputs(&self) -> Vec<Output> {
        let mut by_type = BTreeMap::new();
        for output in self.stages.iter().flat_map(|stage| stage.entry.outputs) {
            by_type.insert(output.value_type.name(), *output);
        }
        by_type.into_values().collect()
    }

    /// The learners, in order.
    pub fn entries(&self) -> impl Iterator<Item = &'static Entry> {
        self.stages.iter().map(|stage| stage.entry)
    }

    /// Forgets what the streams of all learners remember.
    pub fn reset(&mut self) {
        self.stages.iter_mut().for_each(|stage| stage.learner.reset());
    }

    /// Answers one set of inputs, stage after stage.
    ///
    /// # Errors
    /// The first error of a learner; `InvalidInput` for an input that the pipeline does not take.
    pub fn infer(&mut self, ports: &Ports<'_>) -> Result<Outputs> {
        ports.check_names(&self.ports)?;
        let mut answers = Vec::new();
        for stage in &mut self.stages {
            answers.push(stage.infer(ports, &answers)?);
        }
        Ok(merged(answers))
    }

    /// Answers a stream of inputs, each learner on a thread of its own: the slowest sets the pace, not their sum. `begins`
    /// says which items begin a stream, before which the learners forget the one before; `ports` shows an item's inputs;
    /// `each` is handed items and answers in their order, on the calling thread. What fails of one item is told for it, and
    /// the next goes on.
    ///
    /// # Errors
    /// The first error of `each`, which ends the work.
    pub fn run<T: Send, E>(
        &mut self,
        items: impl IntoIterator<Item = T>,
        mut begins: impl FnMut(&T) -> bool,
        ports: impl Fn(&T) -> Result<Ports<'_>> + Sync,
        mut each: impl FnMut(T, Result<Outputs>) -> std::result::Result<(), E>,
    ) -> std::result::Result<(), E> {
        let begun = items.into_iter().map(|item| (begins(&item), item, Ok(Vec::new())));
        let work = |stage: &mut Stage, (begins, item, answers): &mut (bool, T, Result<Vec<Outputs>>)| {
            if *begins {
                stage.learner.reset();
            }
            let Ok(before) = answers else { return };
            match ports(item).and_then(|ports| stage.infer(&ports, before)) {
                Ok(answer) => before.push(answer),
                Err(error) => *answers = Err(error),
            }
        };
        assembly_line(&mut self.stages, begun, work, |(_, item, answers)| each(item, answers.map(merged)))
    }
}

impl Stage {
    fn infer(&mut self, given: &Ports<'_>, before: &[Outputs]) -> Result<Outputs> {
        let mut ports = Ports::default();
        for (port, wire) in self.entry.ports.iter().zip(&self.wires) {
            let value = match wire {
                Wire::Answer { stage, output } => before
                    .get(*stage)
                    .and_then(|outputs| outputs.get(output))
                    .map(opendr_engine::Value::as_value_ref),
                Wire::Input => given.get(port.name),
            };
            if let Some(value) = value {
                ports = ports.with(port.name, value);
            }
        }
        self.learner.infer(&ports).map_err(|error| error.context(self.entry.spec.class))
    }
}

fn takes(entry: &Entry, port: &Port) -> bool {
    entry.ports.iter().any(|other| other.value_type == port.value_type)
}

/// The answers of all, the later where two are of one type.
fn merged(answers: Vec<Outputs>) -> Outputs {
    let mut merged: Vec<(&'static str, opendr_engine::Value)> = Vec::new();
    for (name, value) in answers.into_iter().flatten() {
        merged
            .retain(|(_, earlier)| earlier.as_value_ref().value_type() != value.as_value_ref().value_type());
        merged.push((name, value));
    }
    merged.into_iter().collect()
}
