//! Learners one after the other: a detector, a tracker, what looks at the tracks.

mod adapter;
mod each_box;
#[cfg(feature = "actions")]
mod skeletons;
mod stage;
mod wiring;

use std::collections::BTreeMap;

use opendr_engine::learner::{AnyLearner, Entry, Output, Outputs, Port, Ports};
use opendr_engine::params::ParamMap;
use opendr_engine::target::Classes;
use opendr_engine::{Device, Error, Progress, Result, Silent, Value, ValueType, assembly_line};

use crate::{learner_with, registry};
use opendr_evaluation::Predictor;
use stage::Stage;
use wiring::{Wire, wires};

/// Learners that each take what those before them answer.
///
/// A port takes the newest answer of its type; what no learner before answers is an input of the pipeline, shared by all
/// that take it. So a detector, a tracker over `image` and `detections`, and a recogniser need no wiring by hand. The
/// answers of all are the answer of the pipeline; where two are of one type, the later one.
///
/// Where no answer is of a port's type, one that can be turned into it is taken: poses become moving skeletons, as
/// many frames and persons of them as the model looks at, so that `"movenet/multipose + spatio_temporal_gcn"` tells actions in
/// a video. A learner that has nothing to look at, since nobody is in sight, answers nothing.
///
/// `each` before a learner shows it the boxes found before, one by one, in place of the picture:
/// `"yunet + each facial_emotion"` names every face by its expression. What it answers of a box lies in the whole picture; a
/// category becomes the box's name.
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

/// The word before a learner that looks at each box.
const EACH: &str = "each ";

impl Pipeline {
    /// The learners that `specs` names, with their pretrained models: `"nanodet + yunet/320 + each facial_emotion"`.
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
        let named = |pipeline: Self, spec: &str| pipeline.then_named(spec, device, progress);
        specs.split('+').try_fold(Self::default(), named)
    }

    /// Adds the learner that `spec` names at the end, with its pretrained model: `"yunet/320"`, `"each facial_emotion"`.
    ///
    /// # Errors
    /// As [`Pipeline::open`].
    pub fn then_named(self, spec: &str, device: Device, progress: &dyn Progress) -> Result<Self> {
        let text = spec.trim();
        let (spec, each) = text.strip_prefix(EACH).map_or((text, false), |spec| (spec.trim_start(), true));
        let entry = registry().find(spec.split('/').next().unwrap_or(spec))?;
        let learner = learner_with(spec, &ParamMap::new(), device, progress)?;
        if each { self.then_each(entry, learner.as_ref()) } else { self.then(entry, learner.as_ref()) }
    }

    /// Adds a stream of a loaded learner of `entry` at the end.
    ///
    /// # Errors
    /// `InvalidParam` for one that takes nothing of what those before it answer; `NotFound` for one without a model.
    pub fn then(mut self, entry: &'static Entry, learner: &dyn AnyLearner) -> Result<Self> {
        let answered = self.stages.iter().map(|stage| stage.outputs()).collect::<Vec<_>>();
        let wires = wires(entry.ports, &answered, &mut self.ports);
        let feeds = |wire: &Wire| !matches!(wire, Wire::Input);
        let is_beside =
            entry.ports.iter().all(|port| self.stages.iter().any(|stage| takes(stage.entry, port)));
        if !self.stages.is_empty() && !wires.iter().any(feeds) && !is_beside {
            return Err(self.feeds_not(entry, entry.ports));
        }
        let adapters = wires.iter().map(|wire| match (wire, learner.model()) {
            (Wire::Adapted { make, .. }, Some(model)) => {
                make(model).map(Some).map_err(|error| error.context(entry.spec.class))
            }
            (Wire::Adapted { .. }, None) => {
                Err(Error::not_found(format!("{} has no model; load one first", entry.spec.class)))
            }
            _ => Ok(None),
        });
        let adapters = adapters.collect::<Result<_>>()?;
        let (stream, classes) = (learner.stream()?, learner.classes());
        self.stages.push(Stage { entry, stream, classes, wires, adapters, boxes: None });
        Ok(self)
    }

    /// Adds a stream of a loaded learner of pictures at the end that looks at each of the boxes found before it.
    ///
    /// # Errors
    /// `InvalidParam` where none before it finds boxes, and for a learner that takes more than a picture, or answers what
    /// has no place in one.
    pub fn then_each(mut self, entry: &'static Entry, learner: &dyn AnyLearner) -> Result<Self> {
        const BOXES: Port = Port {
            name: ValueType::BoundingBoxList.port(),
            doc: "",
            value_type: ValueType::BoundingBoxList,
            optional: false,
            init: false,
        };
        each_box::check(entry)?;
        let answered = self.stages.iter().map(|stage| stage.outputs()).collect::<Vec<_>>();
        let boxes = wires(&[BOXES], &answered, &mut Vec::new()).into_iter().next();
        if !matches!(boxes, Some(Wire::Answer { .. })) {
            return Err(self.feeds_not(entry, &[BOXES]));
        }
        let wires = wires(entry.ports, &[], &mut self.ports);
        let (stream, classes) = (learner.stream()?, learner.classes());
        self.stages.push(Stage { entry, stream, classes, wires, adapters: Vec::new(), boxes });
        Ok(self)
    }

    /// That nothing before a learner answers what it takes.
    fn feeds_not(&self, entry: &Entry, ports: &[Port]) -> Error {
        let wanted: Vec<_> = ports.iter().map(|port| port.value_type.name()).collect();
        let there = self.stages.iter().flat_map(|stage| stage.outputs());
        let there: Vec<_> = there.map(|output| output.value_type.name()).collect();
        Error::invalid_param(format!(
            "{} takes {}, and those before it answer {}; put one before it that answers what it takes",
            entry.spec.class,
            wanted.join(", "),
            there.join(", ")
        ))
    }

    /// What it takes.
    pub fn ports(&self) -> &[Port] {
        &self.ports
    }

    /// What it answers.
    pub fn outputs(&self) -> Vec<Output> {
        let mut by_type = BTreeMap::new();
        for output in self.stages.iter().flat_map(Stage::outputs) {
            by_type.insert(output.value_type.name(), output);
        }
        by_type.into_values().collect()
    }

    /// What the class numbers of the last learner mean; targets that carry class names of their own say more.
    pub fn classes(&self) -> Classes {
        self.stages.last().map(|stage| stage.classes.clone()).unwrap_or_default()
    }

    /// The learners, in order.
    pub fn entries(&self) -> impl Iterator<Item = &'static Entry> {
        self.stages.iter().map(|stage| stage.entry)
    }

    /// Forgets what the streams of all learners remember.
    pub fn reset(&mut self) {
        self.stages.iter_mut().for_each(Stage::reset);
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
                stage.reset();
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

impl Predictor for Pipeline {
    fn reset(&mut self) {
        Self::reset(self);
    }

    fn infer(&mut self, ports: &Ports<'_>) -> Result<Outputs> {
        Self::infer(self, ports)
    }
}

fn takes(entry: &Entry, port: &Port) -> bool {
    entry.ports.iter().any(|other| other.value_type == port.value_type)
}

/// The answers of all, the later where two are of one type.
fn merged(answers: Vec<Outputs>) -> Outputs {
    let mut merged: Vec<(&'static str, Value)> = Vec::new();
    for (name, value) in answers.into_iter().flatten() {
        merged
            .retain(|(_, earlier)| earlier.as_value_ref().value_type() != value.as_value_ref().value_type());
        merged.push((name, value));
    }
    merged.into_iter().collect()
}
