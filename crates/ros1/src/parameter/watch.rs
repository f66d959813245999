//! Watched parameters.

use std::collections::BTreeMap;
use std::sync::Mutex;

use opendr_engine::Result;

use crate::ParameterValue;
use crate::context::Context;
use crate::lock::lock;

/// The owner's function for a parameter's changes.
pub(super) type Changed = Box<dyn Fn(&str, &ParameterValue) + Send + Sync>;

/// A watched parameter.
pub(crate) struct Watch {
    pub key: String,
    changed: Changed,
    /// Lock that serialises the calls of `changed`.
    calling: Mutex<()>,
}

impl Watch {
    pub(super) fn new(key: &str, changed: Changed) -> Self {
        Self { key: key.to_owned(), changed, calling: Mutex::default() }
    }

    /// Subscribes to the parameter at the master.
    pub fn register(&self, context: &Context) -> Result<ParameterValue> {
        let params = [context.api_uri.as_str().into(), self.key.as_str().into()];
        let value = context.register("subscribeParam", &params)?;
        Ok(value.unwrap_or_else(|| ParameterValue::Struct(BTreeMap::new())))
    }

    /// Returns whether the parameter `key` is this one or below it.
    pub(super) fn contains(&self, key: &str) -> bool {
        let rest = key.strip_prefix(&self.key);
        self.key == "/" || rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
    }

    /// Calls the owner's function.
    pub(super) fn notify(&self, context: &Context, key: &str, value: &ParameterValue) {
        let _calling = lock(&self.calling);
        context.guarded("the owner's function for parameters", || (self.changed)(key, value));
    }
}
