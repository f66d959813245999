//! When and as what a message was taken.

use opendr_engine::{Result, Value, ValueType};
use opendr_messages::Message;
use opendr_ros_bridge::{RosBridge, nanoseconds};

/// When the datum of a message was taken, where it says that, else when it was recorded; nanoseconds.
pub fn stamp_of(message: &Message, log_time_ns: i64) -> i64 {
    match message.header().map(|header| nanoseconds(&header.stamp)) {
        None | Some(0) => log_time_ns,
        Some(stamp) => stamp,
    }
}

/// The value of a message; one that does not say when it was taken gets `stamp_ns`.
///
/// # Errors
/// `Format` for a message that contradicts itself; `InvalidInput` for one that does not stand for `value_type`.
pub fn value_of(value_type: ValueType, message: Message, stamp_ns: i64) -> Result<Value> {
    let mut value = RosBridge::default().value_from_message(value_type, message)?;
    let header = value.header_mut();
    header.stamp_ns = header.stamp_ns.or(Some(stamp_ns));
    Ok(value)
}
