//! The named outputs of a learner.

use std::fmt;

use crate::{Datum, Header, Value, ValueRef, ValueType};

/// A named output of a learner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Output {
    /// Name, the same on every surface.
    pub name: &'static str,
    /// Description.
    pub doc: &'static str,
    /// Type of the value.
    pub value_type: ValueType,
}

/// The prediction of a learner: one target, or a `#[derive(Targets)]` struct of targets.
pub trait Targets: Default + Send + 'static {
    /// Table of the outputs.
    const OUTPUTS: &'static [Output];

    /// Calls `visit` with the name and value of each output.
    fn visit<'a>(&'a self, visit: &mut dyn FnMut(&'static str, ValueRef<'a>));

    /// Sets time stamp and frame id of every output.
    fn set_header(&mut self, header: &Header);
}

impl<T: Datum + Default> Targets for T {
    const OUTPUTS: &'static [Output] = &[Output { name: T::TYPE.port(), doc: "", value_type: T::TYPE }];

    fn visit<'a>(&'a self, visit: &mut dyn FnMut(&'static str, ValueRef<'a>)) {
        visit(T::TYPE.port(), self.as_value_ref());
    }

    fn set_header(&mut self, header: &Header) {
        self.header_mut().clone_from(header);
    }
}

/// The outputs of one call of an [`AnyLearner`](crate::learner::AnyLearner).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outputs {
    values: Vec<(&'static str, Value)>,
}

impl Outputs {
    pub(crate) fn from_targets(targets: &impl Targets) -> Self {
        let mut values = Vec::new();
        targets.visit(&mut |name, value| values.push((name, value.to_value())));
        Self { values }
    }

    /// Returns the output named `name`.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.values.iter().find(|(output, _)| *output == name).map(|(_, value)| value)
    }

    /// Returns the first output; most learners have only one.
    pub fn first(&self) -> Option<&Value> {
        self.values.first().map(|(_, value)| value)
    }

    /// Returns all outputs with their names.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&'static str, &Value)> {
        self.values.iter().map(|(name, value)| (*name, value))
    }
}

/// Writes the outputs in order: `{}` as OpenDR's text, `{:#}` in readable form.
impl fmt::Display for Outputs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.values.iter().try_for_each(|(_, value)| fmt::Display::fmt(value, f))
    }
}

impl IntoIterator for Outputs {
    type Item = (&'static str, Value);
    type IntoIter = std::vec::IntoIter<Self::Item>;

    fn into_iter(self) -> Self::IntoIter {
        self.values.into_iter()
    }
}

impl FromIterator<(&'static str, Value)> for Outputs {
    fn from_iter<I: IntoIterator<Item = (&'static str, Value)>>(values: I) -> Self {
        Self { values: values.into_iter().collect() }
    }
}
