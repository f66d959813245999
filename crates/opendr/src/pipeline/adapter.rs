//! From the answer of one learner to what another takes, where the types differ.

use opendr_engine::model::Model;
use opendr_engine::{Result, Value, ValueType};

#[cfg(feature = "actions")]
use super::skeletons::Skeletons;

/// Makes, answer after answer of a stream, what a port takes.
pub(super) trait Adapter: Send {
    /// What the port gets for `answer`; `None` where there is nothing to look at.
    fn adapt(&mut self, answer: &Value) -> Result<Option<Value>>;

    /// Forgets the stream.
    fn reset(&mut self);
}

/// Makes an adapter for a learner with its model.
pub(super) type Make = fn(&Model) -> Result<Box<dyn Adapter>>;

/// Every adapter: from which type of answer to which type of port.
const ADAPTERS: &[(ValueType, ValueType, Make)] = &[
    #[cfg(feature = "actions")]
    (ValueType::PoseList, ValueType::SkeletonSequence, Skeletons::make),
];

/// How answers of the type `from` become what a port of the type `to` takes.
pub(super) fn adapter(from: ValueType, to: ValueType) -> Option<Make> {
    ADAPTERS.iter().find(|(answer, port, _)| (*answer, *port) == (from, to)).map(|(.., make)| *make)
}
