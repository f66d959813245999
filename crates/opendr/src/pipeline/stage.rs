//! One learner of a pipeline with its wiring.

use opendr_engine::learner::{AnyStream, Entry, Output, Outputs, Ports};
use opendr_engine::target::Classes;
use opendr_engine::{Result, Value, ValueRef, ValueType};

use super::adapter::Adapter;
use super::each_box;
use super::wiring::Wire;

/// A learner at its position in the pipeline.
pub(super) struct Stage {
    pub entry: &'static Entry,
    pub stream: Box<dyn AnyStream>,
    /// Classes of its predictions.
    pub classes: Classes,
    pub wires: Vec<Wire>,
    /// Adapters by port; `None` for a port without one.
    pub adapters: Vec<Option<Box<dyn Adapter>>>,
    /// Source of the boxes, if the learner runs on each box.
    pub boxes: Option<Wire>,
}

impl Stage {
    /// Returns the outputs of the stage; a learner of categories that runs on each box has boxes as output.
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

    /// Resets the stream.
    pub fn reset(&mut self) {
        self.stream.reset();
        self.adapters.iter_mut().flatten().for_each(|adapter| adapter.reset());
    }

    /// Runs the learner on the pipeline's inputs `inputs` and the outputs `before`; without one of its inputs, returns no outputs.
    pub fn infer(&mut self, inputs: &Ports<'_>, before: &[Outputs]) -> Result<Outputs> {
        self.run(inputs, before).map_err(|error| error.context(self.entry.spec.class))
    }

    fn run(&mut self, inputs: &Ports<'_>, before: &[Outputs]) -> Result<Outputs> {
        let prediction =
            |stage: usize, output: &str| before.get(stage).and_then(|outputs| outputs.get(output));
        if let Some(Wire::Prediction { stage, output }) = &self.boxes {
            let (Some(Value::BoundingBoxList(boxes)), [port]) =
                (prediction(*stage, output), self.entry.ports)
            else {
                return Ok(Outputs::default());
            };
            let image = inputs.required(port.name)?;
            let value = each_box::infer(self.entry, &mut *self.stream, &self.classes, image, boxes)?;
            return Ok([(value.as_value_ref().value_type().port(), value)].into_iter().collect());
        }
        let mut adapted = Vec::new();
        for (wire, adapter) in self.wires.iter().zip(&mut self.adapters) {
            adapted.push(match (wire, adapter) {
                (Wire::Adapted { stage, output, .. }, Some(adapter)) => {
                    prediction(*stage, output).map(|value| adapter.adapt(value)).transpose()?.flatten()
                }
                _ => None,
            });
        }
        let mut ports = Ports::default();
        for ((port, wire), adapted) in self.entry.ports.iter().zip(&self.wires).zip(&adapted) {
            let value: Option<ValueRef<'_>> = match wire {
                Wire::Input => inputs.get(port.name),
                Wire::Prediction { stage, output } => prediction(*stage, output).map(Value::as_value_ref),
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
