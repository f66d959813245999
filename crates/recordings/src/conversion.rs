//! Conversion of recordings between formats.

use std::path::Path;

use opendr_bags::{BagFormat, BagWriter, Channel, Encoding, Selection, WriteOptions};
use opendr_engine::{Error, Progress, Result, ResultExt, Unit};
use opendr_messages::WireFormat;

use crate::Recording;
use crate::channels::{Known, channel_of, unreadable};

/// Options of a conversion.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Conversion {
    /// Format and options of the new recording.
    pub options: WriteOptions,
    /// Topics to convert; `None` for all.
    pub topics: Option<Vec<String>>,
    /// Whether messages of ROS 1 are converted to ROS 2 in an MCAP file, which supports both. The other formats
    /// support one ROS version only.
    pub is_ros2: bool,
}

/// Converts all topics, without conversion of messages that the format supports.
impl<O: Into<WriteOptions>> From<O> for Conversion {
    fn from(options: O) -> Self {
        Self { options: options.into(), topics: None, is_ros2: false }
    }
}

/// How the messages of a channel are converted.
enum Way {
    Copied(usize),
    Converted(Known, WireFormat, usize),
    LeftOut,
}

impl Conversion {
    /// Writes `recording` at `path` and returns the number of messages written. Messages of the other ROS version
    /// are converted if OpenDR supports them. `left_out` is called with an error for each topic and message that is
    /// skipped.
    ///
    /// # Errors
    /// As [`BagWriter::create`]; the errors of reading and those that `left_out` returns.
    pub fn run(
        &self,
        recording: &Recording,
        path: &Path,
        left_out: &mut dyn FnMut(Error) -> Result<()>,
        progress: &dyn Progress,
    ) -> Result<u64> {
        let bag = recording.bag();
        let mut selection = Selection { topics: self.topics.clone(), ..Selection::default() };
        let wants =
            |channel: &Channel| self.topics.as_ref().is_none_or(|topics| topics.contains(&channel.topic));
        let mut writer = BagWriter::create(path, self.options)?;
        let (mut ways, mut total, mut kept) = (Vec::new(), 0_u64, Vec::new());
        for (at, (channel, known)) in bag.channels().iter().zip(recording.known()).enumerate() {
            if !wants(channel) {
                ways.push(Way::LeftOut);
                continue;
            }
            match self.way(&mut writer, channel, *known) {
                Ok(way) => {
                    ways.push(way);
                    total = total.saturating_add(bag.message_counts().get(at).copied().unwrap_or(0));
                    kept.push(channel.topic.clone());
                }
                Err(error) => {
                    left_out(error)?;
                    ways.push(Way::LeftOut);
                }
            }
        }
        selection.topics = Some(kept);
        progress.begin("messages", Some(total), Unit::Items);
        let mut written = 0;
        for message in bag.select(&selection)? {
            if progress.stopped() {
                break;
            }
            // The readable part of a damaged recording is written.
            let message = match message {
                Ok(message) => message,
                Err(error) => {
                    left_out(error.context(recording.path().display().to_string()))?;
                    break;
                }
            };
            let channel = bag.channels().get(message.channel);
            let done = match (ways.get(message.channel), channel) {
                (Some(Way::Copied(number)), _) => writer.copy(*number, &message).map(|()| true),
                (Some(Way::Converted(known, wire, number)), Some(channel)) => {
                    let decoded = known.decode(channel, &message).and_then(|decoded| decoded.to_bytes(*wire));
                    match decoded.context(|| format!("{} at {} ns", channel.topic, message.log_time_ns)) {
                        Ok(bytes) => writer.write(*number, message.log_time_ns, &bytes).map(|()| true),
                        Err(error) => left_out(error).map(|()| false),
                    }
                }
                _ => Ok(false),
            };
            written += u64::from(done?);
            progress.advance(1);
        }
        progress.end();
        writer.finish()?;
        Ok(written)
    }

    fn way(&self, writer: &mut BagWriter, channel: &Channel, known: Known) -> Result<Way> {
        let own = match channel.encoding {
            Encoding::Ros1 => Some(WireFormat::Ros1),
            Encoding::Cdr => Some(WireFormat::Cdr),
            Encoding::Other(_) => None,
        };
        let needed = match self.options.format {
            BagFormat::Bag1 => Some(WireFormat::Ros1),
            BagFormat::Mcap if !self.is_ros2 => own,
            _ => Some(WireFormat::Cdr),
        };
        match (known, needed) {
            _ if own.is_some() && own == needed => writer.add_channel(channel.clone()).map(Way::Copied),
            (Known::Type(message_type, _), Some(wire)) => {
                let number = writer.add_channel(channel_of(&channel.topic, message_type, wire)?)?;
                Ok(Way::Converted(known, wire, number))
            }
            _ => Err(unreadable(channel, known)),
        }
    }
}
