//! One learner of a pipeline, and what goes into it.

use opendr_engine::learner::{AnyStream, Entry, Output, Outputs, Ports};
use opendr_engine::target::Classes;
use opendr_engine::{Result, Value, ValueRef, ValueType};

use super::adapter::Adapter;
use super::each_box;
use super::wiring::Wire;

/// A learner in its place.
pub(super) struct Stage {
    pub entry: &'static Entry,
    pub stream: Box<dyn AnyStream>,
    /// What the class numbers of its predictions mean.
    pub classes: Classes,
    pub wires: Vec<Wire>,
    /// One for each port whose answer is of another type.
    pub adapters: Vec<Option<Box<dyn Adapter>>>,
    /// Where the boxes are that the learner looks at one by one.
    pub boxes: Option<Wire>,
}

impl Stage {
    /// What it answers; of boxes looked at one by one, that is boxes again where the learner answers categories.
    pub fn outputs(&self) -> Vec<Output> {
        let category_is_box = |output: &Output| match (&self.boxes, output.value_type) {
            (Some(_), ValueType::Category) => {
                let value_type = ValueType::BoundingBoxList;
                Output { name: value_type.port(), value_type, ..*output }
            }
            _ => *output,
        };
        self.entry.outputs.iter().map(category_is_box).collect()
    }

    /// Forgets the stream.
    pub fn reset(&mut self) {
        self.stream.reset();
        self.adapters.iter_mut().flatten().for_each(|adapter| adapter.reset());
    }

    /// Its answer to the pipeline's inputs and what those before it answered; nothing where one of these is not there.
    pub fn infer(&mut self, given: &Ports<'_>, before: &[Outputs]) -> Result<Outputs> {
        self.answer(given, before).map_err(|error| error.context(self.entry.spec.class))
    }

    fn answer(&mut self, given: &Ports<'_>, before: &[Outputs]) -> Result<Outputs> {
        let answer = |stage: usize, output: &str| before.get(stage).and_then(|outputs| outputs.get(output));
        if let Some(Wire::Answer { stage, output }) = &self.boxes {
            let (Some(Value::BoundingBoxList(boxes)), [port]) = (answer(*stage, output), self.entry.ports)
            else {
                return Ok(Outputs::default());
            };
            let image = given.required(port.name)?;
            let value = each_box::infer(self.entry, &mut *self.stream, &self.classes, image, boxes)?;
            return Ok([(value.as_value_ref().value_type().port(), value)].into_iter().collect());
        }
        let mut adapted = Vec::new();
        for (wire, adapter) in self.wires.iter().zip(&mut self.adapters) {
            adapted.push(match (wire, adapter) {
                (Wire::Adapted { stage, output, .. }, Some(adapter)) => {
                    answer(*stage, output).map(|value| adapter.adapt(value)).transpose()?.flatten()
                }
                _ => None,
            });
        }
        let mut ports = Ports::default();
        for ((port, wire), adapted) in self.entry.ports.iter().zip(&self.wires).zip(&adapted) {
            let value: Option<ValueRef<'_>> = match wire {
                Wire::Input => given.get(port.name),
                Wire::Answer { stage, output } => answer(*stage, output).map(Value::as_value_ref),
                Wire::Adapted { .. } => adapted.as_ref().map(Value::as_value_ref),
            };
            match value {
                Some(value) => ports = ports.with(port.name, value),
                None if port.optional || matches!(wire, Wire::Input) => {}
                None => return Ok(Outputs::default()),
            }
        }
        self.stream.infer(&ports)
    }
}
