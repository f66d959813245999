//! A topic of a recording, and what it can stand for.

use opendr_engine::ValueType;
use opendr_messages::MessageType;
use opendr_ros_bridge::message_types;

/// All messages of one name in a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Topic {
    /// Its name, e.g. `/camera/image_raw`.
    pub name: String,
    /// Its type as the recording names it.
    pub type_name: String,
    /// Its type where OpenDR reads it; `None` for others, other encodings and other versions of a message.
    pub message_type: Option<MessageType>,
    /// A message that OpenDR knows in another version.
    pub is_other_version: bool,
    /// How many messages the recording says that there are: never allocate by it.
    pub messages: u64,
}

impl Topic {
    /// Whether its messages can be read as `value_type`.
    pub fn fits(&self, value_type: ValueType) -> bool {
        self.message_type.is_some_and(|known| message_types(value_type).any(|fitting| fitting == known))
    }

    /// A line for lists: name, type, number of messages.
    pub(crate) fn line(&self, value_type: ValueType) -> String {
        let remark = match (self.fits(value_type), self.is_other_version) {
            (true, _) => " (fits)",
            (false, true) => " (of another version than OpenDR's)",
            (false, false) => "",
        };
        format!("\n  {}  {}, {} messages{remark}", self.name, self.type_name, self.messages)
    }
}
