//! Validated fields of a line.

use opendr_engine::{Error, Result};
use serde_json::{Map, Value};

use crate::Timestamp;
use crate::storage::python_json::number_from_value;

/// The fields of a line.
pub struct Fields<'a>(pub &'a Map<String, Value>);

impl Fields<'_> {
    fn read<T>(&self, key: &str, what: &str, read: impl FnOnce(&Value) -> Option<T>) -> Result<T> {
        let value = self.0.get(key).ok_or_else(|| Error::format(format!("no field {key:?}")))?;
        read(value).ok_or_else(|| Error::format(format!("{key} is not a {what}")))
    }

    pub fn text(&self, key: &str) -> Result<String> {
        self.read(key, "string", |value| value.as_str().map(str::to_owned))
    }

    pub fn whole(&self, key: &str) -> Result<i64> {
        self.read(key, "whole number", Value::as_i64)
    }

    pub fn index(&self, key: &str) -> Result<usize> {
        self.read(key, "number from 0", |value| usize::try_from(value.as_u64()?).ok())
    }

    pub fn number(&self, key: &str) -> Result<f64> {
        self.read(key, "number", number_from_value)
    }

    pub fn list(&self, key: &str) -> Result<&Vec<Value>> {
        let value = self.0.get(key).and_then(Value::as_array);
        value.ok_or_else(|| Error::format(format!("{key} is not a list")))
    }

    /// Returns the numbers of a list; empty if it is missing.
    pub fn numbers(&self, key: &str) -> Result<Vec<f64>> {
        match self.0.get(key) {
            None | Some(Value::Null) => Ok(Vec::new()),
            Some(_) => {
                let number = |value| {
                    number_from_value(value).ok_or_else(|| {
                        Error::format(format!("{key} contains {value}, which is not a number"))
                    })
                };
                self.list(key)?.iter().map(number).collect()
            }
        }
    }

    pub fn optional(&self, key: &str) -> Option<&Value> {
        self.0.get(key)
    }

    /// Returns the fields of an object; empty if it is missing.
    pub fn object(&self, key: &str) -> Result<Map<String, Value>> {
        match self.0.get(key) {
            None => Ok(Map::new()),
            Some(Value::Object(map)) => Ok(map.clone()),
            Some(_) => Err(Error::format(format!("{key} is not an object"))),
        }
    }

    pub fn moment(&self, key: &str) -> Result<Option<Timestamp>> {
        match self.0.get(key) {
            None | Some(Value::Null) => Ok(None),
            Some(_) => self.read(key, "moment", |value| Timestamp::parse(value.as_str()?)).map(Some),
        }
    }

    pub fn note(&self, key: &str) -> Result<(String, Value)> {
        let mut notes = self.object(key)?.into_iter();
        match (notes.next(), notes.next()) {
            (Some(note), None) => Ok(note),
            _ => Err(Error::format(format!("{key} must have exactly one entry"))),
        }
    }
}
