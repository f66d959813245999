//! Stamps and values of messages.

use opendr_engine::{Result, Value, ValueType};
use opendr_messages::Message;
use opendr_ros_bridge::{RosBridge, nanoseconds};

/// Returns the stamp of a message in nanoseconds, or the log time if it has none.
pub fn stamp_of(message: &Message, log_time_ns: i64) -> i64 {
    match message.header().map(|header| nanoseconds(&header.stamp)) {
        None | Some(0) => log_time_ns,
        Some(stamp) => stamp,
    }
}

/// Converts a message to a value; one without a stamp gets `stamp_ns`.
///
/// # Errors
/// `Format` for an inconsistent message; `InvalidInput` for one that does not represent `value_type`.
pub fn value_of(value_type: ValueType, message: Message, stamp_ns: i64) -> Result<Value> {
    let mut value = RosBridge::default().value_from_message(value_type, message)?;
    let header = value.header_mut();
    header.stamp_ns = header.stamp_ns.or(Some(stamp_ns));
    Ok(value)
}
