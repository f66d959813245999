//! The description of a parameter.

use std::fmt;

use crate::params::{ParamKind, ParamMap, ParamValue};
use crate::{Error, Result};

/// Range of a numeric parameter, both ends included.
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

/// Default of a [`Field`].
#[derive(Debug, Clone, Copy)]
pub enum FieldDefault {
    /// A function, for the fields of a struct.
    Function(fn() -> ParamValue),
    /// A value, for learners that are registered at run time.
    Value(&'static ParamValue),
}

impl FieldDefault {
    /// Returns the default value.
    pub fn value(self) -> ParamValue {
        match self {
            Self::Function(make) => make(),
            Self::Value(value) => value.clone(),
        }
    }
}

/// Description of a parameter, for all surfaces.
#[derive(Debug, Clone, Copy)]
pub struct Field {
    /// Name, the same on every surface.
    pub name: &'static str,
    /// Documentation: the doc comment of the field.
    pub doc: &'static str,
    /// Type of the value.
    pub kind: ParamKind,
    /// Whether the value may be absent.
    pub optional: bool,
    /// Allowed texts; empty if any text is allowed.
    pub choices: &'static [&'static str],
    /// Range of a number.
    pub range: Option<ParamRange>,
    /// Unit of a number, e.g. `"px"`; empty for none.
    pub unit: &'static str,
    /// Whether hyperparameter searches sample it on a logarithmic scale.
    pub log_scale: bool,
    /// Whether it can be set while a model is loaded.
    pub live: bool,
    /// Alternative names in Python: those of OpenDR.
    pub aliases: &'static [&'static str],
    /// Former names, which are still accepted on every surface and in saved models.
    pub former: &'static [&'static str],
    /// Default value.
    pub default: FieldDefault,
}

impl Field {
    /// Returns whether `name` is the name or a former name of the parameter.
    pub fn is_called(&self, name: &str) -> bool {
        self.name == name || self.former.contains(&name)
    }

    /// Returns the value of the parameter in `map`, under its name or a former one.
    pub fn value_in<'a>(&self, map: &'a ParamMap) -> Option<&'a ParamValue> {
        std::iter::once(&self.name).chain(self.former).find_map(|name| map.get(*name))
    }

    /// Checks type, range and choices.
    ///
    /// # Errors
    /// Returns `InvalidParam` with the name, the value and the allowed values.
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

    /// Parses a value from the command line: lists are separated by commas, `none` is an absent value.
    ///
    /// # Errors
    /// Returns `InvalidParam` if the text is not of the type of the field.
    pub fn parse(&self, text: &str) -> Result<ParamValue> {
        let mismatch = || self.wrong_type(&ParamValue::Text(text.to_owned()));
        if self.optional && text == "none" {
            return Ok(ParamValue::None);
        }
        match self.kind {
            ParamKind::Float => text.parse().map(ParamValue::Float).map_err(|_| mismatch()),
            ParamKind::Int => text.parse().map(ParamValue::Int).map_err(|_| mismatch()),
            ParamKind::Bool => match text {
                "true" | "on" | "yes" | "1" => Ok(ParamValue::Bool(true)),
                "false" | "off" | "no" | "0" => Ok(ParamValue::Bool(false)),
                _ => Err(mismatch()),
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
