//! Message types of the channels of a recording.

use opendr_bags::{BagFormat, Channel, Encoding, RecordedMessage};
use opendr_engine::{Error, Result, ResultExt};
use opendr_messages::{Message, MessageType, WireFormat};

/// Whether OpenDR can decode the messages of a channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Known {
    Type(MessageType, WireFormat),
    OtherVersion,
    Unknown,
}

impl Known {
    /// Looks up a channel by the name of its type, and by its hash if the recording has it.
    pub fn of(channel: &Channel) -> Self {
        let wire = match channel.encoding {
            Encoding::Ros1 => WireFormat::Ros1,
            Encoding::Cdr => WireFormat::Cdr,
            Encoding::Other(_) => return Self::Unknown,
        };
        let Ok(message_type) = channel.message_type.parse::<MessageType>() else { return Self::Unknown };
        let ours = match wire {
            WireFormat::Cdr => Some(message_type.rihs01()),
            WireFormat::Ros1 => message_type.ros1().map(|known| known.md5sum),
        };
        let Some(ours) = ours else { return Self::Unknown };
        match channel.type_hash.as_deref() {
            Some(theirs) if !["", "*", ours].contains(&theirs) => Self::OtherVersion,
            _ => Self::Type(message_type, wire),
        }
    }

    /// Decodes a message of the channel.
    pub fn decode(self, channel: &Channel, message: &RecordedMessage) -> Result<Message> {
        let Self::Type(message_type, wire) = self else {
            return Err(unreadable(channel, self));
        };
        Message::from_bytes(message_type, wire, &message.bytes).context(|| channel.topic.clone())
    }
}

#[cold]
pub(crate) fn unreadable(channel: &Channel, known: Known) -> Error {
    let Channel { topic, message_type, encoding, .. } = channel;
    let why = match known {
        Known::OtherVersion => "OpenDR supports another version of this message".to_owned(),
        _ => format!("OpenDR does not support this message in the encoding {encoding}"),
    };
    Error::unsupported(format!("{topic} ({message_type}): {why}"))
}

/// Returns the encoding in which messages are written to a format.
pub(crate) fn wire_of(format: BagFormat) -> WireFormat {
    if format == BagFormat::Bag1 { WireFormat::Ros1 } else { WireFormat::Cdr }
}

/// Returns a channel for messages of `message_type`.
pub(crate) fn channel_of(topic: &str, message_type: MessageType, wire: WireFormat) -> Result<Channel> {
    let definition = message_type.definition(wire)?;
    let (name, hash, encoding) = match wire {
        WireFormat::Cdr => (message_type.ros2_name(), message_type.rihs01(), Encoding::Cdr),
        WireFormat::Ros1 => {
            let known = message_type.ros1();
            let known = known.ok_or_else(|| Error::internal("the message has a definition, but no type"))?;
            (known.name, known.md5sum, Encoding::Ros1)
        }
    };
    Ok(Channel::new(topic, name, encoding).with_definition(definition).with_type_hash(hash))
}
