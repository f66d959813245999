//! One received message, shared by several learners.

use std::sync::{Mutex, OnceLock, PoisonError};

use opendr_engine::{Error, Result, Value, ValueType};
use opendr_messages::Message;
use opendr_ros_bridge::{RosBridge, nanoseconds, time};

/// A message that is converted to a value at the first use.
pub(crate) struct Frame {
    message: Mutex<Option<Result<Message>>>,
    value_type: ValueType,
    value: OnceLock<Result<Value>>,
    /// Stamp of the datum, else the time of arrival, in nanoseconds of the ROS clock.
    pub(crate) stamp_ns: i64,
}

impl Frame {
    /// Creates a frame of a message that arrived at `now_ns`, which is the stamp of a message without one.
    pub(crate) fn new(mut message: Result<Message>, value_type: ValueType, now_ns: i64) -> Self {
        let mut stamp_ns = now_ns;
        if let Ok(message) = &mut message
            && let Some(header) = message.header_mut()
        {
            match nanoseconds(&header.stamp) {
                0 => header.stamp = time(now_ns).unwrap_or_default(),
                stamp => stamp_ns = stamp,
            }
        }
        let message = Mutex::new(Some(message));
        Self { message, value_type, value: OnceLock::new(), stamp_ns }
    }

    /// Returns the value, which is converted once.
    pub(crate) fn value(&self) -> Result<&Value> {
        let read = || {
            let message = self.message.lock().unwrap_or_else(PoisonError::into_inner).take();
            let message =
                message.unwrap_or_else(|| Err(Error::internal("the message was already converted")))?;
            let stamped = message.header().is_some();
            let mut value = RosBridge::default().value_from_message(self.value_type, message)?;
            if !stamped {
                value.header_mut().stamp_ns = Some(self.stamp_ns);
            }
            Ok(value)
        };
        self.value.get_or_init(read).as_ref().map_err(|error| Error::new(error.kind(), error.to_string()))
    }
}
