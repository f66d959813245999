//! The adapters.

use opendr_engine::ValueType;

use super::adapter::Make;
#[cfg(feature = "actions")]
use super::skeletons::Skeletons;

/// All adapters, by type of prediction and type of port.
const ADAPTERS: &[(ValueType, ValueType, Make)] = &[
    #[cfg(feature = "actions")]
    (ValueType::PoseList, ValueType::SkeletonSequence, Skeletons::make),
];

/// Returns the adapter from predictions of type `from` to ports of type `to`.
pub(super) fn adapter(from: ValueType, to: ValueType) -> Option<Make> {
    ADAPTERS.iter().find(|(answer, port, _)| (*answer, *port) == (from, to)).map(|(.., make)| *make)
}
