//! The named outputs of a learner.

use std::fmt;

use crate::{Datum, Header, Value, ValueRef, ValueType};

/// One named output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Output {
    /// Its name on every surface.
    pub name: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// Its type.
    pub value_type: ValueType,
}

/// What a learner answers: one target, or a `#[derive(Targets)]` struct of targets.
pub trait Targets: Default + Send + 'static {
    /// The table of outputs.
    const OUTPUTS: &'static [Output];

    /// Shows each output by name.
    fn visit<'a>(&'a self, visit: &mut dyn FnMut(&'static str, ValueRef<'a>));

    /// Gives every output the stamp and frame of the input.
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

/// The outputs of one call through the dynamic interface.
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

    /// The output called `name`.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.values.iter().find(|(output, _)| *output == name).map(|(_, value)| value)
    }

    /// The first output: the only one of most learners.
    pub fn first(&self) -> Option<&Value> {
        self.values.first().map(|(_, value)| value)
    }

    /// Every output with its name.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&'static str, &Value)> {
        self.values.iter().map(|(name, value)| (*name, value))
    }
}

/// The outputs one after the other, as they print themselves: `{}` in OpenDR's words, `{:#}` for people.
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
