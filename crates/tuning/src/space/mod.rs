//! Search spaces.

mod from_dictionaries;
mod from_fields;

use opendr_engine::{Error, Result};
use serde_json::Value;

use crate::Distribution;

pub use from_fields::defaults_from_fields;

/// Condition of a parameter: it is active only when another has one of some values.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// Name of the other parameter, which precedes this one.
    pub parent: String,
    /// Values of the other parameter with which this one is active.
    pub values: Vec<Value>,
}

/// A parameter of a [`SearchSpace`].
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Name.
    pub name: String,
    /// Distribution.
    pub distribution: Distribution,
    /// Condition; `None` if the parameter is always active.
    pub condition: Option<Condition>,
    /// Index in the space.
    pub(crate) position: usize,
}

/// Parameters in the order in which they are drawn.
///
/// ```
/// use opendr_tuning::{Distribution, SearchSpace};
///
/// # fn main() -> opendr_engine::Result<()> {
/// let space = SearchSpace::new()
///     .with("lr", Distribution::log_float(1e-5, 1e-1)?)?
///     .with("optimizer", Distribution::categorical(["sgd", "adam"])?)?
///     .with_when("momentum", Distribution::float(0.0, 0.99)?, "optimizer", ["sgd"])?;
/// assert_eq!(space.parameters().len(), 3);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SearchSpace {
    parameters: Vec<Parameter>,
}

impl SearchSpace {
    /// Creates a space without parameters.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a parameter.
    ///
    /// # Errors
    /// `InvalidParam` for a duplicate name, or an empty distribution.
    pub fn with(self, name: impl Into<String>, distribution: Distribution) -> Result<Self> {
        self.added(name.into(), distribution, None)
    }

    /// Adds a parameter that is active only when `parent` has one of `values`.
    ///
    /// # Errors
    /// As [`SearchSpace::with`], and when no earlier parameter is called `parent` or it cannot take one of `values`.
    pub fn with_when<T: Into<Value>>(
        self,
        name: impl Into<String>,
        distribution: Distribution,
        parent: &str,
        values: impl IntoIterator<Item = T>,
    ) -> Result<Self> {
        let name = name.into();
        let Some(other) = self.parameters.iter().find(|known| known.name == parent) else {
            return Err(Error::invalid_param(format!(
                "{name}: no earlier parameter {parent:?}; add it before this one"
            )));
        };
        let values: Vec<Value> = values.into_iter().map(Into::into).collect();
        for value in &values {
            other
                .distribution
                .number_from_value(value)
                .map_err(|error| error.context(format!("{name}: {parent}")))?;
        }
        self.added(name, distribution, Some(Condition { parent: parent.to_owned(), values }))
    }

    fn added(
        mut self,
        name: String,
        distribution: Distribution,
        condition: Option<Condition>,
    ) -> Result<Self> {
        if self.parameters.iter().any(|known| known.name == name) {
            return Err(Error::invalid_param(format!("parameter {name:?} occurs twice in the search space")));
        }
        let distribution = distribution.checked().map_err(|error| error.context(name.as_str()))?;
        let position = self.parameters.len();
        self.parameters.push(Parameter { name, distribution, condition, position });
        Ok(self)
    }

    /// Returns the parameters, in the order in which they are drawn.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Groups the parameters by condition, in order; those of a group are active together and drawn together.
    pub(crate) fn groups(&self) -> Vec<Vec<&Parameter>> {
        let mut groups: Vec<Vec<&Parameter>> = Vec::new();
        for parameter in &self.parameters {
            match groups.iter_mut().find(|group| group[0].condition == parameter.condition) {
                Some(group) => group.push(parameter),
                None => groups.push(vec![parameter]),
            }
        }
        groups
    }
}

#[cfg(test)]
mod tests;
