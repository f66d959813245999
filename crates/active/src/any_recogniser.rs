//! Learners by name as recognisers.

use opendr_engine::data::Image;
use opendr_engine::learner::{AnyLearner, AnyStream, Entry, Ports};
use opendr_engine::{Error, Result, Value, ValueType};

use crate::evidence::{ClassEvidence as _, logarithms};
use crate::recogniser::ViewRecogniser;

/// A learner of the registry, with an image port and a target that has classes, as a recogniser of views.
pub struct AnyRecogniser {
    stream: Box<dyn AnyStream>,
    port: &'static str,
    classes: usize,
}

impl AnyRecogniser {
    /// Creates a recogniser from a loaded learner of `entry`, for `classes` classes.
    ///
    /// # Errors
    /// Returns `Unsupported` for a learner without an image port or without classes.
    pub fn new(learner: &dyn AnyLearner, entry: &Entry, classes: usize) -> Result<Self> {
        let port = entry.ports.iter().find(|port| port.value_type == ValueType::Image);
        let has_classes = |value_type| {
            matches!(value_type, ValueType::Category | ValueType::BoundingBoxList | ValueType::PoseList)
        };
        let needs_more = entry.ports.iter().filter(|port| !port.optional).count() != 1;
        match port {
            Some(port)
                if !needs_more && entry.outputs.iter().any(|output| has_classes(output.value_type)) =>
            {
                Ok(Self { stream: learner.stream()?, port: port.name, classes })
            }
            _ => Err(Error::unsupported(format!(
                "{} does not classify single images, so no camera can be moved for it",
                entry.spec.class
            ))),
        }
    }
}

impl ViewRecogniser for AnyRecogniser {
    fn classes(&self) -> usize {
        self.classes
    }

    fn recognise(&mut self, image: &Image, evidence: &mut [f32]) -> Result<()> {
        self.stream.reset();
        let outputs = self.stream.infer(&Ports::default().with(self.port, image))?;
        let is_written = outputs.iter().any(|(_, value)| write_evidence(value, evidence));
        if is_written { Ok(()) } else { Err(Error::internal("a learner without its declared output")) }
    }
}

/// Writes the logarithm of the probability of each class that a target states. Returns whether it is a target with classes.
pub fn write_evidence(target: &Value, evidence: &mut [f32]) -> bool {
    match target {
        Value::Category(target) => target.class_probabilities(evidence),
        Value::BoundingBoxList(target) => target.class_probabilities(evidence),
        Value::PoseList(target) => target.class_probabilities(evidence),
        _ => return false,
    }
    logarithms(evidence);
    true
}
