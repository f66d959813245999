//! One row of a table of parameters.

use std::fmt;

use crate::params::{ParamKind, ParamValue};
use crate::{Error, Result};

/// What numbers a field takes, both ends included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParamRange {
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
}

impl fmt::Display for ParamRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}..={}", self.low, self.high)
    }
}

/// Where the default of a [`Field`] comes from.
#[derive(Debug, Clone, Copy)]
pub enum FieldDefault {
    /// From the definition of a struct.
    Made(fn() -> ParamValue),
    /// From a learner that is registered at run time.
    Given(&'static ParamValue),
}

impl FieldDefault {
    /// The default.
    pub fn value(self) -> ParamValue {
        match self {
            Self::Made(make) => make(),
            Self::Given(value) => value.clone(),
        }
    }
}

/// One parameter: all that any surface needs to know of it.
#[derive(Debug, Clone, Copy)]
pub struct Field {
    /// The name on every surface.
    pub name: &'static str,
    /// The documentation, from the field's doc comment.
    pub doc: &'static str,
    /// Its type.
    pub kind: ParamKind,
    /// Whether it may be absent.
    pub optional: bool,
    /// The words it takes, where it takes only some.
    pub choices: &'static [&'static str],
    /// The numbers it takes.
    pub range: Option<ParamRange>,
    /// The unit of the number, e.g. `"px"`; empty when it has none.
    pub unit: &'static str,
    /// Whether a search should step by factors.
    pub log_scale: bool,
    /// Whether it may change while the learner runs.
    pub live: bool,
    /// Other names that Python takes for it: those that it had in OpenDR.
    pub aliases: &'static [&'static str],
    /// Its default.
    pub default: FieldDefault,
}

impl Field {
    /// Checks type, range and choices.
    ///
    /// # Errors
    /// `InvalidParam` with the name, the value and what is allowed.
    pub fn check(&self, value: &ParamValue) -> Result<()> {
        if matches!(value, ParamValue::None) && self.optional {
            return Ok(());
        }
        if let ParamValue::List(items) = value {
            return match self.kind {
                ParamKind::List => items.iter().try_for_each(|item| self.check_range(item)),
                _ => Err(self.wrong_type(value)),
            };
        }
        let fits = match self.kind {
            ParamKind::Float => matches!(value, ParamValue::Float(_) | ParamValue::Int(_)),
            ParamKind::Int => value.as_int().is_some(),
            ParamKind::Bool => matches!(value, ParamValue::Bool(_)),
            ParamKind::Text => matches!(value, ParamValue::Text(_)),
            ParamKind::List => false,
        };
        if !fits {
            return Err(self.wrong_type(value));
        }
        if let (ParamValue::Text(text), false) = (value, self.choices.is_empty())
            && !self.choices.contains(&text.as_str())
        {
            let choices = self.choices.join(", ");
            return Err(Error::invalid_param(format!("{} = {text:?}: give one of {choices}", self.name)));
        }
        self.check_range(value)
    }

    fn check_range(&self, value: &ParamValue) -> Result<()> {
        let Some(number) = value.as_float() else { return Ok(()) };
        match self.range {
            Some(range) if !(range.low..=range.high).contains(&number) => {
                Err(Error::invalid_param(format!("{} = {number} is out of range {range}", self.name)))
            }
            None if !number.is_finite() => {
                Err(Error::invalid_param(format!("{} = {number}: give a finite number", self.name)))
            }
            _ => Ok(()),
        }
    }

    /// Reads the value as a command line writes it; lists are separated by commas, `none` is absence.
    ///
    /// # Errors
    /// `InvalidParam` when the text is not of the field's type.
    pub fn parse(&self, text: &str) -> Result<ParamValue> {
        let wrong = || self.wrong_type(&ParamValue::Text(text.to_owned()));
        if self.optional && text == "none" {
            return Ok(ParamValue::None);
        }
        match self.kind {
            ParamKind::Float => text.parse().map(ParamValue::Float).map_err(|_| wrong()),
            ParamKind::Int => text.parse().map(ParamValue::Int).map_err(|_| wrong()),
            ParamKind::Bool => match text {
                "true" | "on" | "yes" | "1" => Ok(ParamValue::Bool(true)),
                "false" | "off" | "no" | "0" => Ok(ParamValue::Bool(false)),
                _ => Err(wrong()),
            },
            ParamKind::Text => Ok(ParamValue::Text(text.to_owned())),
            ParamKind::List => Ok(ParamValue::List(text.split(',').map(ParamValue::guess).collect())),
        }
    }

    #[cold]
    pub(crate) fn wrong_type(&self, value: &ParamValue) -> Error {
        Error::invalid_param(format!("{} = {value} should be {}", self.name, self.kind))
    }
}
