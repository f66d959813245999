//! Conversion of predictions into the input type of a later learner.

use opendr_engine::model::Model;
use opendr_engine::{Result, Value};

/// Converts the predictions of a stream, one after the other, into values of a port.
pub(super) trait Adapter: Send {
    /// Returns the value of the port for `prediction`; `None` if the learner should not run.
    fn adapt(&mut self, prediction: &Value) -> Result<Option<Value>>;

    /// Resets the state of the stream.
    fn reset(&mut self);
}

/// Creates an adapter for the model of the later learner.
pub(super) type Make = fn(&Model) -> Result<Box<dyn Adapter>>;
