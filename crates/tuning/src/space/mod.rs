//! What a study searches through.

mod from_dictionaries;
mod from_fields;

use opendr_engine::{Error, Result};
use serde_json::Value;

use crate::Distribution;

pub use from_fields::defaults_from_fields;

/// When a parameter takes part: only where another has one of some values.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// The other parameter, which stands before this one.
    pub parent: String,
    /// Its values with which this one takes part.
    pub values: Vec<Value>,
}

/// One parameter of a [`SearchSpace`].
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// What it may be.
    pub distribution: Distribution,
    /// When it takes part; `None` for always.
    pub condition: Option<Condition>,
    /// Its place in the space.
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
    /// A space without parameters.
    pub fn new() -> Self {
        Self::default()
    }

    /// With one more parameter.
    ///
    /// # Errors
    /// `InvalidParam` when there is one of this name, or no value is in the distribution.
    pub fn with(self, name: impl Into<String>, distribution: Distribution) -> Result<Self> {
        self.added(name.into(), distribution, None)
    }

    /// With one more parameter, which takes part only where `parent` has one of `values`.
    ///
    /// # Errors
    /// As [`SearchSpace::with`], and when there is no `parent` before it or that cannot take one of `values`.
    pub fn with_when<T: Into<Value>>(
        self,
        name: impl Into<String>,
        distribution: Distribution,
        parent: &str,
        values: impl IntoIterator<Item = T>,
    ) -> Result<Self> {
        let name = name.into();
        let Some(other) = self.parameters.iter().find(|known| known.name == parent) else {
            return Err(Error::invalid_param(format!("{name}: no parameter {parent:?} stands before it")));
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
            return Err(Error::invalid_param(format!("parameter {name:?} stands twice in the search space")));
        }
        let distribution = distribution.checked().map_err(|error| error.context(name.as_str()))?;
        let position = self.parameters.len();
        self.parameters.push(Parameter { name, distribution, condition, position });
        Ok(self)
    }

    /// The parameters, in the order in which they are drawn.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// The parameters by condition, in order: those of a group take part together, so that they can be drawn together.
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
