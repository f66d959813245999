//! Recordings written from values.

use std::collections::HashMap;
use std::path::Path;

use opendr_bags::{BagFormat, BagWriter, Channel, RecordedMessage, WriteOptions};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Header, Result, ResultExt, ValueRef};
use opendr_messages::{Message, MessageType, WireFormat};
use opendr_ros_bridge::{ClassIds, RosBridge, label_info, message_types, view_action};

use crate::Recording;
use crate::channels::{Known, channel_of, unreadable, wire_of};

/// Writer of values as messages: ROS 1's in rosbag 1, ROS 2's in the other formats.
///
/// Classes are written by name, in ROS 1 by number, since its messages have no field for names. A dropped writer
/// finishes the recording, but ignores errors: use [`RecordingWriter::finish`].
#[derive(Debug)]
pub struct RecordingWriter {
    writer: BagWriter,
    wire: WireFormat,
    bridge: RosBridge,
    channels: HashMap<(String, MessageType), usize>,
    /// Channels of messages that are copied without decoding.
    copied: HashMap<(String, String), usize>,
}

impl RecordingWriter {
    /// Creates a recording at `path`. Takes a [`BagFormat`] or [`WriteOptions`].
    ///
    /// # Errors
    /// As [`BagWriter::create`].
    pub fn create(path: impl AsRef<Path>, options: impl Into<WriteOptions>) -> Result<Self> {
        let options = options.into();
        let wire = wire_of(options.format);
        let class_ids = if wire == WireFormat::Ros1 { ClassIds::Numbers } else { ClassIds::Names };
        let bridge = RosBridge { class_ids, ..RosBridge::default() };
        let writer = BagWriter::create(path, options)?;
        Ok(Self { writer, wire, bridge, channels: HashMap::new(), copied: HashMap::new() })
    }

    /// Writes a value on `topic` as the default message of its type.
    ///
    /// # Errors
    /// `InvalidInput` for a value that the message cannot express; otherwise as [`BagWriter::write`].
    pub fn write(&mut self, topic: &str, value: ValueRef<'_>, log_time_ns: i64) -> Result<()> {
        let value_type = value.value_type();
        let message_type = message_types(value_type).next();
        let message_type = message_type
            .ok_or_else(|| Error::unsupported(format!("no ROS message represents {}", value_type.name())))?;
        self.write_as(topic, value, message_type, log_time_ns)
    }

    /// Writes a value on `topic` as a message of `message_type`.
    ///
    /// # Errors
    /// As [`RecordingWriter::write`]; `InvalidInput` if messages of this type do not represent the value.
    pub fn write_as(
        &mut self,
        topic: &str,
        value: ValueRef<'_>,
        message_type: MessageType,
        log_time_ns: i64,
    ) -> Result<()> {
        let message = self.bridge.message_from_value(value, message_type).context(|| topic.to_owned())?;
        self.write_message(topic, &message, log_time_ns)
    }

    /// Writes the names of the classes, if the format has a message for them.
    ///
    /// # Errors
    /// As [`RecordingWriter::write`].
    pub fn write_classes(&mut self, topic: &str, classes: &Classes, log_time_ns: i64) -> Result<()> {
        if self.wire == WireFormat::Ros1 || classes.is_empty() {
            return Ok(());
        }
        let header = Header { stamp_ns: Some(log_time_ns), frame_id: None };
        self.write_message(topic, &label_info(classes, &header, 0.0)?.into(), log_time_ns)
    }

    /// Writes the action of a prediction for a better view (active perception), if it has one.
    ///
    /// # Errors
    /// As [`RecordingWriter::write`].
    pub fn write_action(
        &mut self,
        topic: &str,
        value: ValueRef<'_>,
        header: &Header,
        log_time_ns: i64,
    ) -> Result<()> {
        let Some(action) = value.action() else { return Ok(()) };
        self.write_message(topic, &view_action(action, header)?.into(), log_time_ns)
    }

    /// Writes a message.
    ///
    /// # Errors
    /// `Unsupported` if the ROS version of the format has no such message; otherwise as [`BagWriter::write`].
    pub fn write_message(&mut self, topic: &str, message: &Message, log_time_ns: i64) -> Result<()> {
        let message_type = message.message_type();
        let bytes = message.to_bytes(self.wire).context(|| topic.to_owned())?;
        let key = (topic.to_owned(), message_type);
        let channel = match self.channels.get(&key) {
            Some(channel) => *channel,
            None => {
                let channel = self.writer.add_channel(channel_of(topic, message_type, self.wire)?)?;
                self.channels.insert(key, channel);
                channel
            }
        };
        self.writer.write(channel, log_time_ns, &bytes).context(|| topic.to_owned())
    }

    /// Copies a message of another recording to its own topic, converted if the format needs messages of the other
    /// ROS version.
    ///
    /// # Errors
    /// As [`RecordingWriter::write_message`]; `Unsupported` for a message that needs conversion and is unknown to OpenDR.
    pub fn copy(&mut self, recording: &Recording, message: &RecordedMessage) -> Result<()> {
        let channel = recording.bag().channels().get(message.channel);
        let channel = channel.ok_or_else(|| Error::invalid_input("the message is of another recording"))?;
        match recording.known().get(message.channel) {
            Some(Known::Type(_, wire)) if *wire == self.wire => self.copy_bytes(channel, message),
            Some(known @ Known::Type(..)) => {
                let decoded = known.decode(channel, message)?;
                self.write_message(&channel.topic, &decoded, message.log_time_ns)
            }
            known => Err(unreadable(channel, known.copied().unwrap_or(Known::Unknown))),
        }
    }

    fn copy_bytes(&mut self, channel: &Channel, message: &RecordedMessage) -> Result<()> {
        let key = (channel.topic.clone(), channel.message_type.clone());
        let number = match self.copied.get(&key) {
            Some(number) => *number,
            None => {
                let number = self.writer.add_channel(channel.clone())?;
                self.copied.insert(key, number);
                number
            }
        };
        self.writer.copy(number, message)
    }

    /// Returns whether the format keeps messages of ROS 1.
    pub fn is_ros1(&self) -> bool {
        self.wire == WireFormat::Ros1
    }

    /// Writes the remaining messages and the index.
    ///
    /// # Errors
    /// As [`BagWriter::finish`].
    pub fn finish(self) -> Result<()> {
        self.writer.finish()
    }

    /// Returns the default format for a file of this name; `None` if the extension is not one of recordings.
    pub fn format_of(path: &Path) -> Option<BagFormat> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "bag" => Some(BagFormat::Bag1),
            "mcap" => Some(BagFormat::Mcap),
            _ => None,
        }
    }
}
