//! A recording in another format.

use std::path::Path;

use opendr_bags::{BagFormat, BagWriter, Channel, Encoding, Selection, WriteOptions};
use opendr_engine::{Error, Progress, Result, ResultExt, Unit};
use opendr_messages::Wire;

use crate::Recording;
use crate::channels::{Known, channel_of, unreadable};

/// How a recording is converted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Conversion {
    /// How it is written.
    pub options: WriteOptions,
    /// Only these topics; `None` is all of them.
    pub topics: Option<Vec<String>>,
    /// An MCAP file gets messages of ROS 2 also from a recording of ROS 1. The other formats keep those of one ROS only.
    pub is_ros2: bool,
}

/// All topics as they are, as far as the format keeps them.
impl<O: Into<WriteOptions>> From<O> for Conversion {
    fn from(options: O) -> Self {
        Self { options: options.into(), topics: None, is_ros2: false }
    }
}

/// What becomes of a channel.
enum Way {
    Copied(usize),
    Converted(Known, Wire, usize),
    LeftOut,
}

impl Conversion {
    /// Writes `recording` at `path`; how many messages that were. Messages of the other ROS are converted where OpenDR knows
    /// them; `left_out` is told of topics that are left out, and of single messages that are.
    ///
    /// # Errors
    /// As [`BagWriter::create`]; what the recording itself or `left_out` ends with.
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
            // A recording that breaks off is written as far as it goes.
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
            Encoding::Ros1 => Some(Wire::Ros1),
            Encoding::Cdr => Some(Wire::Cdr),
            Encoding::Other(_) => None,
        };
        let wanted = match self.options.format {
            BagFormat::Bag1 => Some(Wire::Ros1),
            BagFormat::Mcap if !self.is_ros2 => own,
            _ => Some(Wire::Cdr),
        };
        match (known, wanted) {
            _ if own.is_some() && own == wanted => writer.add_channel(channel.clone()).map(Way::Copied),
            (Known::Type(message_type, _), Some(wire)) => {
                let number = writer.add_channel(channel_of(&channel.topic, message_type, wire)?)?;
                Ok(Way::Converted(known, wire, number))
            }
            _ => Err(unreadable(channel, known)),
        }
    }
}
