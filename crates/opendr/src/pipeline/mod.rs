//! Pipelines: learners in sequence, such as a detector, a tracker and a recogniser of the tracks.

mod adapter;
mod adapters;
mod each_box;
#[cfg(feature = "actions")]
mod skeletons;
mod stage;
mod wiring;

use std::collections::BTreeMap;

use opendr_engine::learner::{AnyLearner, Entry, Output, Outputs, Port, Ports};
use opendr_engine::params::ParamMap;
use opendr_engine::target::Classes;
use opendr_engine::{Device, Error, Progress, Result, Silent, Value, ValueType, map_in_stages};

use crate::{learner_with, registry};
use opendr_evaluation::Predictor;
use stage::Stage;
use wiring::{Wire, wires};

/// Learners in sequence, each with the predictions of those before it as inputs.
///
/// A port gets the newest prediction of its type. A port whose type no earlier learner predicts is an input of the pipeline,
/// shared by all learners with such a port. A detector, a tracker over `image` and `detections`, and a recogniser therefore need
/// no manual wiring. The output of the pipeline is the predictions of all learners; of two of one type, the later one.
///
/// If no prediction has a port's type, one that converts to it is used: poses become skeleton sequences with the frames and
/// persons of the model, so that `"movenet/multipose + spatio_temporal_gcn"` recognises actions in a video. A learner without an
/// input, such as an empty list of poses, returns no output.
///
/// `each` before a learner runs it on the crop of each detected box instead of the image: `"yunet + each facial_emotion"` names
/// every face by its expression. Outputs are in pixels of the whole image; a category becomes the name of the box.
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

/// Prefix of a learner that runs on each box.
const EACH: &str = "each ";

impl Pipeline {
    /// Loads the learners that `specs` names, with their pretrained models: `"nanodet + yunet/320 + each facial_emotion"`.
    ///
    /// # Errors
    /// As [`crate::learner()`] and [`Pipeline::then`].
    pub fn open(specs: &str) -> Result<Self> {
        Self::open_with(specs, Device::Auto, &Silent)
    }

    /// As [`Pipeline::open`], with a device and a progress display for the downloads.
    ///
    /// # Errors
    /// As [`Pipeline::open`].
    pub fn open_with(specs: &str, device: Device, progress: &dyn Progress) -> Result<Self> {
        let named = |pipeline: Self, spec: &str| pipeline.then_named(spec, device, progress);
        specs.split('+').try_fold(Self::default(), named)
    }

    /// Appends the learner that `spec` names, with its pretrained model: `"yunet/320"`, `"each facial_emotion"`.
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

    /// Appends a stream of a loaded learner of `entry`.
    ///
    /// # Errors
    /// `InvalidParam` if no port matches a prediction of the learners before it; `NotFound` for a learner without a model.
    pub fn then(mut self, entry: &'static Entry, learner: &dyn AnyLearner) -> Result<Self> {
        let predicted = self.stages.iter().map(|stage| stage.outputs()).collect::<Vec<_>>();
        let wires = wires(entry.ports, &predicted, &mut self.ports);
        let feeds = |wire: &Wire| !matches!(wire, Wire::Input);
        let is_beside =
            entry.ports.iter().all(|port| self.stages.iter().any(|stage| takes(stage.entry, port)));
        if !self.stages.is_empty() && !wires.iter().any(feeds) && !is_beside {
            return Err(self.unmatched_ports(entry, entry.ports));
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

    /// Appends a stream of a loaded learner that runs on the crop of each box detected before it.
    ///
    /// # Errors
    /// `InvalidParam` if no learner before it predicts boxes, if the learner has inputs besides an image, or if its outputs cannot
    /// be merged.
    pub fn then_each(mut self, entry: &'static Entry, learner: &dyn AnyLearner) -> Result<Self> {
        const BOXES: Port = Port {
            name: ValueType::BoundingBoxList.port(),
            doc: "",
            value_type: ValueType::BoundingBoxList,
            optional: false,
            init: false,
        };
        each_box::check(entry)?;
        let predicted = self.stages.iter().map(|stage| stage.outputs()).collect::<Vec<_>>();
        let boxes = wires(&[BOXES], &predicted, &mut Vec::new()).into_iter().next();
        if !matches!(boxes, Some(Wire::Prediction { .. })) {
            return Err(self.unmatched_ports(entry, &[BOXES]));
        }
        let wires = wires(entry.ports, &[], &mut self.ports);
        let (stream, classes) = (learner.stream()?, learner.classes());
        self.stages.push(Stage { entry, stream, classes, wires, adapters: Vec::new(), boxes });
        Ok(self)
    }

    /// Returns the error of a learner whose inputs no earlier learner predicts.
    fn unmatched_ports(&self, entry: &Entry, ports: &[Port]) -> Error {
        let wanted: Vec<_> = ports.iter().map(|port| port.value_type.name()).collect();
        let predicted_types = self.stages.iter().flat_map(|stage| stage.outputs());
        let predicted_types: Vec<_> = predicted_types.map(|output| output.value_type.name()).collect();
        Error::invalid_param(format!(
            "the inputs of {} are {}, but the learners before it predict {}; put a learner with such an output before it",
            entry.spec.class,
            wanted.join(", "),
            predicted_types.join(", ")
        ))
    }

    /// Returns the inputs of the pipeline.
    pub fn ports(&self) -> &[Port] {
        &self.ports
    }

    /// Returns the outputs of the pipeline.
    pub fn outputs(&self) -> Vec<Output> {
        let mut by_type = BTreeMap::new();
        for output in self.stages.iter().flat_map(Stage::outputs) {
            by_type.insert(output.value_type.name(), output);
        }
        by_type.into_values().collect()
    }

    /// Returns the classes of the last learner; targets may contain class names of their own.
    pub fn classes(&self) -> Classes {
        self.stages.last().map(|stage| stage.classes.clone()).unwrap_or_default()
    }

    /// Returns the learners, in order.
    pub fn entries(&self) -> impl Iterator<Item = &'static Entry> {
        self.stages.iter().map(|stage| stage.entry)
    }

    /// Resets the streams of all learners.
    pub fn reset(&mut self) {
        self.stages.iter_mut().for_each(Stage::reset);
    }

    /// Runs the learners on one set of inputs, in sequence.
    ///
    /// # Errors
    /// The first error of a learner; `InvalidInput` for an input that the pipeline does not have.
    pub fn infer(&mut self, ports: &Ports<'_>) -> Result<Outputs> {
        ports.check_names(&self.ports)?;
        let mut predictions = Vec::new();
        for stage in &mut self.stages {
            predictions.push(stage.infer(ports, &predictions)?);
        }
        Ok(merged(predictions))
    }

    /// Runs the learners on a stream of items, each learner on its own thread, so that the slowest determines the rate. `begins`
    /// returns whether an item begins a stream, before which the learners are reset; `ports` returns the inputs of an item; `each`
    /// receives items and outputs in order, on the calling thread. An error of one item is passed to `each`, and the next item
    /// follows.
    ///
    /// # Errors
    /// The first error of `each`, which ends the run.
    pub fn run<T: Send, E>(
        &mut self,
        items: impl IntoIterator<Item = T>,
        mut begins: impl FnMut(&T) -> bool,
        ports: impl Fn(&T) -> Result<Ports<'_>> + Sync,
        mut each: impl FnMut(T, Result<Outputs>) -> std::result::Result<(), E>,
    ) -> std::result::Result<(), E> {
        let begun = items.into_iter().map(|item| (begins(&item), item, Ok(Vec::new())));
        let work = |stage: &mut Stage, (begins, item, predictions): &mut (bool, T, Result<Vec<Outputs>>)| {
            if *begins {
                stage.reset();
            }
            let Ok(before) = predictions else { return };
            match ports(item).and_then(|ports| stage.infer(&ports, before)) {
                Ok(outputs) => before.push(outputs),
                Err(error) => *predictions = Err(error),
            }
        };
        map_in_stages(&mut self.stages, begun, work, |(_, item, predictions)| {
            each(item, predictions.map(merged))
        })
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

/// Merges the predictions of all learners; of two of one type, the later remains.
fn merged(predictions: Vec<Outputs>) -> Outputs {
    let mut merged: Vec<(&'static str, Value)> = Vec::new();
    for (name, value) in predictions.into_iter().flatten() {
        merged
            .retain(|(_, earlier)| earlier.as_value_ref().value_type() != value.as_value_ref().value_type());
        merged.push((name, value));
    }
    merged.into_iter().collect()
}
