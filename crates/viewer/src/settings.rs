//! Live parameters of the learner.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use opendr_engine::params::{Field, ParamKind, ParamMap, ParamValue};
use opendr_engine::{Error, Result};
use serde_json::json;

/// Live parameters and their requested values.
#[derive(Debug)]
pub struct Settings {
    fields: &'static [Field],
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    values: ParamMap,
    /// Number of the change of each changed parameter.
    changed: BTreeMap<String, u64>,
    count: u64,
    /// Why a change was not applied.
    failure: Option<String>,
}

impl Settings {
    /// Creates the settings of a learner from its fields and values.
    pub fn new(fields: &'static [Field], values: ParamMap) -> Self {
        let state = State { values, changed: BTreeMap::new(), count: 0, failure: None };
        Self { fields, state: Mutex::new(state) }
    }

    /// Requests a value.
    ///
    /// # Errors
    /// `NotFound` for a name that is no live parameter; `InvalidParam` for a value that it cannot have.
    pub fn request(&self, name: &str, value: ParamValue) -> Result<()> {
        let field = self
            .fields
            .iter()
            .find(|field| field.live && field.name == name)
            .ok_or_else(|| Error::not_found(format!("no live parameter {name:?}")))?;
        let value = match (field.kind, value) {
            (ParamKind::Float, ParamValue::Int(number)) => ParamValue::Float(number as f64),
            (_, value) => value,
        };
        field.check(&value)?;
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.count += 1;
        let count = state.count;
        state.values.insert(name.to_owned(), value);
        state.changed.insert(name.to_owned(), count);
        state.failure = None;
        Ok(())
    }

    /// Returns the parameters that were changed after change number `last`, and updates it.
    pub fn changes(&self, last: &mut u64) -> Vec<(String, ParamValue)> {
        let state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let newer = state.changed.iter().filter(|(_, number)| **number > *last);
        let changes = newer.filter_map(|(name, _)| Some((name.clone(), state.values.get(name)?.clone())));
        let changes = changes.collect();
        *last = state.count;
        changes
    }

    /// Reports why a change was not applied.
    pub fn fail(&self, text: String) {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).failure = Some(text);
    }

    /// Returns the live parameters as JSON, and why the last change was not applied.
    pub fn to_json(&self) -> (Vec<serde_json::Value>, Option<String>) {
        let state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let live = self.fields.iter().filter(|field| field.live);
        let params = live.map(|field| {
            let value = field.value_in(&state.values).cloned().unwrap_or_else(|| field.default.value());
            json!({
                "name": field.name,
                "doc": field.doc,
                "kind": format!("{:?}", field.kind).to_lowercase(),
                "unit": field.unit,
                "low": field.range.map(|range| range.low),
                "high": field.range.map(|range| range.high),
                "choices": field.choices,
                "value": value,
            })
        });
        (params.collect(), state.failure.clone())
    }
}
