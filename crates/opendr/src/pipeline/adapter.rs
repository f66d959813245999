//! Conversion of predictions into the input type of a later learner.

use opendr_engine::model::Model;
use opendr_engine::{Result, Value, ValueType};

#[cfg(feature = "actions")]
use super::skeletons::Skeletons;

/// Converts the predictions of a stream, one after the other, into values of a port.
pub(super) trait Adapter: Send {
    /// Returns the value of the port for `prediction`; `None` if the learner should not run.
    fn adapt(&mut self, prediction: &Value) -> Result<Option<Value>>;

    /// Resets the state of the stream.
    fn reset(&mut self);
}

/// Creates an adapter for the model of the later learner.
pub(super) type Make = fn(&Model) -> Result<Box<dyn Adapter>>;

/// All adapters, by type of prediction and type of port.
const ADAPTERS: &[(ValueType, ValueType, Make)] = &[
    #[cfg(feature = "actions")]
    (ValueType::PoseList, ValueType::SkeletonSequence, Skeletons::make),
];

/// Returns the adapter from predictions of type `from` to ports of type `to`.
pub(super) fn adapter(from: ValueType, to: ValueType) -> Option<Make> {
    ADAPTERS.iter().find(|(answer, port, _)| (*answer, *port) == (from, to)).map(|(.., make)| *make)
}
