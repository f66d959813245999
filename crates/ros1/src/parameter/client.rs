//! Access to parameters.

use opendr_engine::{Error, ErrorKind, Result};

use super::ParameterWatch;
use crate::master::CALL_TIME;
use crate::{Node, ParameterValue};

impl Node {
    /// Returns the parameter `key`; a namespace is a struct.
    ///
    /// # Errors
    /// `NotFound` when it is not set, `InvalidParam` for an invalid name, `Network` without a master.
    pub fn parameter(&self, key: &str) -> Result<ParameterValue> {
        self.graph.context.master.call("getParam", &[self.resolve(key)?.into()])
    }

    /// Returns the parameter `key`, or `None` when it is not set.
    ///
    /// # Errors
    /// `InvalidParam` for an invalid name, `Network` without a master.
    pub fn parameter_if_set(&self, key: &str) -> Result<Option<ParameterValue>> {
        match self.parameter(key) {
            Ok(value) => Ok(Some(value)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Sets the parameter `key`; a struct replaces a whole namespace.
    ///
    /// # Errors
    /// `InvalidInput` for text that XML cannot hold, else as [`Node::parameter`].
    pub fn set_parameter(&self, key: &str, value: impl Into<ParameterValue>) -> Result<()> {
        self.graph.context.master.call("setParam", &[self.resolve(key)?.into(), value.into()]).map(|_| ())
    }

    /// Returns whether the parameter `key` is set.
    ///
    /// # Errors
    /// As [`Node::parameter`].
    pub fn has_parameter(&self, key: &str) -> Result<bool> {
        let answer = self.graph.context.master.call("hasParam", &[self.resolve(key)?.into()])?;
        answer.as_bool().ok_or_else(|| Error::format("hasParam of the master did not return a Boolean"))
    }

    /// Deletes the parameter `key`.
    ///
    /// # Errors
    /// As [`Node::parameter`].
    pub fn delete_parameter(&self, key: &str) -> Result<()> {
        self.graph.context.master.call("deleteParam", &[self.resolve(key)?.into()]).map(|_| ())
    }

    /// Returns the full name of the nearest parameter `key`, searched from the node's namespace upwards.
    ///
    /// # Errors
    /// As [`Node::parameter`].
    pub fn search_parameter(&self, key: &str) -> Result<Option<String>> {
        self.graph.context.names.resolve(key)?;
        match self.graph.context.master.call_within("searchParam", &[key.into()], CALL_TIME) {
            Ok(found) => Ok(found.as_str().map(str::to_owned)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Returns the full names of all parameters.
    ///
    /// # Errors
    /// `Network` without a master.
    pub fn parameter_names(&self) -> Result<Vec<String>> {
        self.graph.context.master.call_for_texts("getParamNames", &[])
    }

    /// Calls `changed` with the full name and the new value whenever `key` or a parameter below it changes; a deleted parameter is an
    /// empty struct. Returns the current value, or an empty struct if it is not set.
    ///
    /// # Errors
    /// As [`Node::parameter`].
    pub fn watch_parameter(
        &self,
        key: &str,
        changed: impl Fn(&str, &ParameterValue) + Send + Sync + 'static,
    ) -> Result<(ParameterWatch, ParameterValue)> {
        ParameterWatch::new(&self.graph, &self.resolve(key)?, Box::new(changed))
    }
}
