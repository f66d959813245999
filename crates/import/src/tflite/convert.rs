//! Conversion of the operators in order, as far as the outputs need them.

use opendr_engine::{Error, Result, ResultExt};

use super::model::{Model, Node};
use super::names::name;
use super::operator::step;
use super::step::Step;
use super::trace::Trace;
use crate::tensorflow::{Attributes, Value};

/// Maximum number of inputs or outputs, above that of real operators.
const MAX_PORTS: usize = 4096;

impl<'a, 'f> Trace<'_, 'a, 'f> {
    /// Writes the operators that these tensors need.
    ///
    /// # Errors
    /// `Format` where operators are not in order, and the errors of writing an operator.
    pub fn write(&mut self, outputs: &[usize]) -> Result<Vec<Value>> {
        let needed = needed(self.model, outputs)?;
        for (number, node) in self.model.operators.iter().enumerate().filter(|(number, _)| needed[*number]) {
            let name = node.outputs.first().map_or("", |&output| self.model.tensors[output].name);
            let at = || format!("importing operator {number} ({}), which produces {name:?}", described(node));
            self.lower(node, name).context(at)?;
        }
        outputs.iter().map(|&output| self.value(output)).collect()
    }

    fn lower(&mut self, node: &Node<'a, 'f>, name: &str) -> Result<()> {
        let Step { op, attr, inputs, activation } = step(self, node)?;
        let made = if op.is_empty() { inputs } else { self.call(name, op, &attr, inputs)? };
        if made.len() < node.outputs.len() {
            return Err(Error::format(format!(
                "it produces {} tensors instead of {}",
                made.len(),
                node.outputs.len()
            )));
        }
        for (&output, mut value) in node.outputs.iter().zip(made) {
            let quantisation = self.model.tensors[output].quantisation.as_ref();
            if let Some(activation) = activation
                && !quantisation.is_some_and(|quantisation| quantisation.includes(activation))
            {
                let active = self.call(name, activation, &Attributes::default(), vec![value])?;
                value =
                    active.into_iter().next().ok_or_else(|| Error::internal("activation without output"))?;
            }
            self.define(output, value)?;
        }
        Ok(())
    }
}

/// Returns which operators these tensors need, searched backwards: operators are stored in order of execution.
fn needed(model: &Model, outputs: &[usize]) -> Result<Vec<bool>> {
    let mut wanted = vec![false; model.tensors.len()];
    outputs.iter().for_each(|&output| wanted[output] = true);
    let mut needed = vec![false; model.operators.len()];
    for (number, node) in model.operators.iter().enumerate().rev() {
        if node.inputs.len().max(node.outputs.len()) > MAX_PORTS {
            return Err(Error::format(format!(
                "an operator has {} inputs and {} outputs; the file is damaged or hostile",
                node.inputs.len(),
                node.outputs.len()
            )));
        }
        if node.outputs.iter().any(|&output| wanted[output]) {
            needed[number] = true;
            node.inputs.iter().flatten().for_each(|&input| wanted[input] = true);
        }
    }
    Ok(needed)
}

fn described(node: &Node) -> String {
    match node.custom {
        "" => name(node.code).map_or_else(|| format!("number {}", node.code), str::to_owned),
        custom => format!("custom operator {custom}"),
    }
}
