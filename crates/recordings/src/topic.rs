//! Topics of a recording and the types as which they are readable.

use opendr_engine::ValueType;
use opendr_messages::MessageType;
use opendr_ros_bridge::message_types;

/// The messages of one topic in a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Topic {
    /// Name of the topic, e.g. `/camera/image_raw`.
    pub name: String,
    /// Type name in the recording.
    pub type_name: String,
    /// Type if OpenDR supports it; `None` for other types, encodings and versions of a message.
    pub message_type: Option<MessageType>,
    /// Whether OpenDR supports another version of this message.
    pub is_other_version: bool,
    /// Number of messages stated by the recording. It may be wrong in a damaged file: do not allocate by it.
    pub messages: u64,
}

impl Topic {
    /// Returns whether the messages are readable as `value_type`.
    pub fn fits(&self, value_type: ValueType) -> bool {
        self.message_type.is_some_and(|known| message_types(value_type).any(|fitting| fitting == known))
    }

    /// Returns a line for lists: name, type, number of messages.
    pub(crate) fn line(&self, value_type: ValueType) -> String {
        let remark = match (self.fits(value_type), self.is_other_version) {
            (true, _) => " (fits)",
            (false, true) => " (OpenDR supports another version)",
            (false, false) => "",
        };
        format!("\n  {}  {}, {} messages{remark}", self.name, self.type_name, self.messages)
    }
}
