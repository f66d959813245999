//! Values written as messages.

use std::collections::HashMap;
use std::path::Path;

use opendr_bags::{BagFormat, BagWriter, Channel, Recorded, WriteOptions};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Header, Result, ResultExt, ValueRef};
use opendr_messages::{Message, MessageType, Wire};
use opendr_ros_bridge::{ClassIds, RosBridge, label_info, message_types, view_action};

use crate::Recording;
use crate::channels::{Known, channel_of, unreadable, wire_of};

/// A recording of values: rosbag 1 gets messages of ROS 1, the other formats those of ROS 2.
///
/// Classes go by name, in ROS 1 by number, since its messages have no place for names. Dropped without
/// [`Answers::finish`], the recording is finished as far as that works.
#[derive(Debug)]
pub struct Answers {
    writer: BagWriter,
    wire: Wire,
    bridge: RosBridge,
    channels: HashMap<(String, MessageType), usize>,
    /// Channels of messages that are handed on as they are.
    copied: HashMap<(String, String), usize>,
}

impl Answers {
    /// Starts a recording at `path`. Takes a [`BagFormat`] or [`WriteOptions`].
    ///
    /// # Errors
    /// As [`BagWriter::create`].
    pub fn create(path: impl AsRef<Path>, options: impl Into<WriteOptions>) -> Result<Self> {
        let options = options.into();
        let wire = wire_of(options.format);
        let class_ids = if wire == Wire::Ros1 { ClassIds::Numbers } else { ClassIds::Names };
        let bridge = RosBridge { class_ids, ..RosBridge::default() };
        let writer = BagWriter::create(path, options)?;
        Ok(Self { writer, wire, bridge, channels: HashMap::new(), copied: HashMap::new() })
    }

    /// Writes a value on `topic` as the usual message of its type.
    ///
    /// # Errors
    /// `InvalidInput` for what the message has no place for; else as [`BagWriter::write`].
    pub fn write(&mut self, topic: &str, value: ValueRef<'_>, log_time_ns: i64) -> Result<()> {
        let value_type = value.value_type();
        let message_type = message_types(value_type).next();
        let message_type = message_type
            .ok_or_else(|| Error::unsupported(format!("no message stands for {}", value_type.name())))?;
        self.write_as(topic, value, message_type, log_time_ns)
    }

    /// Writes a value on `topic` as a message of `message_type`.
    ///
    /// # Errors
    /// As [`Answers::write`]; `InvalidInput` when no message of this type stands for the value.
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

    /// Writes what class numbers mean, where the format has a message for it.
    ///
    /// # Errors
    /// As [`Answers::write`].
    pub fn write_classes(&mut self, topic: &str, classes: &Classes, log_time_ns: i64) -> Result<()> {
        if self.wire == Wire::Ros1 || classes.is_empty() {
            return Ok(());
        }
        let header = Header { stamp_ns: Some(log_time_ns), frame_id: None };
        self.write_message(topic, &label_info(classes, &header, 0.0)?.into(), log_time_ns)
    }

    /// Writes how to move to see better, where the value says it.
    ///
    /// # Errors
    /// As [`Answers::write`].
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
    /// `Unsupported` when the format's ROS has no such message; else as [`BagWriter::write`].
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

    /// Writes a message of another recording on its own topic, converted where the format wants the other ROS's.
    ///
    /// # Errors
    /// As [`Answers::write_message`]; `Unsupported` for a message to be converted that OpenDR does not know.
    pub fn copy(&mut self, recording: &Recording, message: &Recorded) -> Result<()> {
        let channel = recording.bag().channels().get(message.channel);
        let channel = channel.ok_or_else(|| Error::invalid_input("a message of another recording"))?;
        match recording.known().get(message.channel) {
            Some(Known::Type(_, wire)) if *wire == self.wire => self.hand_on(channel, message),
            Some(known @ Known::Type(..)) => {
                let decoded = known.decode(channel, message)?;
                self.write_message(&channel.topic, &decoded, message.log_time_ns)
            }
            known => Err(unreadable(channel, known.copied().unwrap_or(Known::Unknown))),
        }
    }

    fn hand_on(&mut self, channel: &Channel, message: &Recorded) -> Result<()> {
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

    /// Its format keeps messages of ROS 1 or ROS 2.
    pub fn is_ros1(&self) -> bool {
        self.wire == Wire::Ros1
    }

    /// Writes the rest and the index.
    ///
    /// # Errors
    /// As [`BagWriter::finish`].
    pub fn finish(self) -> Result<()> {
        self.writer.finish()
    }

    /// The usual format for a file of this name; `None` for a name that is none of a recording.
    pub fn format_of(path: &Path) -> Option<BagFormat> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "bag" => Some(BagFormat::Bag1),
            "mcap" => Some(BagFormat::Mcap),
            _ => None,
        }
    }
}
