//! Search spaces from the parameters of learners.

use std::collections::BTreeMap;

use opendr_engine::params::{Field, ParamKind, ParamValue};
use opendr_engine::{Error, Result};
use serde_json::Value;

use crate::{Distribution, SearchSpace};

impl SearchSpace {
    /// Creates the space of the named fields, with the ranges, choices and scales that the learner declares. A
    /// logarithmic range that begins at 0 is replaced by two decades on each side of the default.
    ///
    /// # Errors
    /// `InvalidParam` for an unknown field, or one without range and choices.
    pub fn from_fields(fields: &[Field], names: &[&str]) -> Result<Self> {
        names.iter().try_fold(Self::new(), |space, name| {
            space.with(*name, distribution_from_field(field_named(fields, name)?)?)
        })
    }
}

/// Returns the defaults of the named fields, for [`Study::enqueue`](crate::Study::enqueue): a learner's defaults are a good
/// first trial.
///
/// # Errors
/// `InvalidParam` for an unknown field.
pub fn defaults_from_fields(fields: &[Field], names: &[&str]) -> Result<BTreeMap<String, Value>> {
    let value =
        |name: &&str| Ok(((*name).to_owned(), json_from_value(&field_named(fields, name)?.default.value())));
    names.iter().map(value).collect()
}

fn field_named<'a>(fields: &'a [Field], name: &str) -> Result<&'a Field> {
    fields.iter().find(|field| field.name == name).ok_or_else(|| {
        let names: Vec<_> = fields.iter().map(|field| field.name).collect();
        Error::invalid_param(format!("no parameter {name:?} to tune; available: {}", names.join(", ")))
    })
}

fn distribution_from_field(field: &Field) -> Result<Distribution> {
    let unknown = |what: &str| Error::invalid_param(format!("{}: {what}; give its distribution", field.name));
    match (field.kind, field.range) {
        (ParamKind::Bool, _) => Distribution::categorical([false, true]),
        (ParamKind::Text, _) if !field.choices.is_empty() => {
            Distribution::categorical(field.choices.iter().copied())
        }
        (ParamKind::Float | ParamKind::Int, Some(range)) => {
            let (mut low, mut high) = (range.low, range.high);
            if field.log_scale && low <= 0.0 {
                let default = field.default.value().as_float().filter(|default| *default > 0.0);
                let default = default.ok_or_else(|| unknown("a logarithmic range cannot begin at 0"))?;
                (low, high) = (default / 100.0, high.min(default * 100.0));
            }
            match (field.kind, field.log_scale) {
                (ParamKind::Int, true) => Distribution::log_int(low.ceil() as i64, high.floor() as i64),
                (ParamKind::Int, false) => Distribution::int(low.ceil() as i64, high.floor() as i64),
                (_, true) => Distribution::log_float(low, high),
                (_, false) => Distribution::float(low, high),
            }
            .map_err(|error| error.context(field.name))
        }
        _ => Err(unknown("the parameter has neither range nor choices")),
    }
}

fn json_from_value(value: &ParamValue) -> Value {
    match value {
        ParamValue::None => Value::Null,
        ParamValue::Bool(value) => Value::from(*value),
        ParamValue::Int(value) => Value::from(*value),
        ParamValue::Float(value) => Value::from(*value),
        ParamValue::Text(value) => Value::from(value.as_str()),
        ParamValue::List(values) => values.iter().map(json_from_value).collect(),
    }
}
