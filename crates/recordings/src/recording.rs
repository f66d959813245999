//! Recordings whose messages can be decoded.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use opendr_bags::{Bag, RecordedMessage};
use opendr_engine::{Error, Result, ValueType};
use opendr_messages::{Message, MessageType};

use crate::Topic;
use crate::channels::Known;

/// First key of the `metadata.yaml` of rosbag 2; other files of this name do not have it.
const METADATA: &[u8] = b"rosbag2_bagfile_information";

/// Returns whether `path` is a recording by its name: a file with an extension of recordings, or a folder with the
/// `metadata.yaml` of rosbag 2 or only its files.
pub fn is_recording(path: &Path) -> bool {
    let is_one_of = |path: &Path, known: &[&str]| {
        let extension = path.extension().and_then(|extension| extension.to_str());
        extension.is_some_and(|extension| known.iter().any(|known| known.eq_ignore_ascii_case(extension)))
    };
    if !path.is_dir() {
        return is_one_of(path, &["bag", "mcap", "db3"]);
    }
    let mut start = Vec::new();
    let read = File::open(path.join("metadata.yaml")).and_then(|file| file.take(256).read_to_end(&mut start));
    if read.is_ok() {
        return start.windows(METADATA.len()).any(|window| window == METADATA);
    }
    // After a crash, a recording has files without metadata.
    let Ok(entries) = path.read_dir() else { return false };
    let mut files = entries.flatten().map(|entry| entry.path()).peekable();
    files.peek().is_some() && files.all(|file| is_one_of(&file, &["db3", "mcap"]))
}

/// An opened recording.
#[derive(Debug)]
pub struct Recording {
    path: PathBuf,
    bag: Bag,
    known: Vec<Known>,
}

impl Recording {
    /// Opens the recording at `path`, of any format.
    ///
    /// # Errors
    /// As [`Bag::open`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let bag = Bag::open(path)?;
        let known = bag.channels().iter().map(Known::of).collect();
        Ok(Self { path: path.to_owned(), bag, known })
    }

    /// Returns the path of the recording.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the recording as raw messages.
    pub fn bag(&self) -> &Bag {
        &self.bag
    }

    /// Returns the topics, sorted by name. If channels of a topic differ in type, the first one counts.
    pub fn topics(&self) -> Vec<Topic> {
        let mut topics: Vec<Topic> = Vec::new();
        let counts = self.bag.message_counts();
        for (at, (channel, known)) in self.bag.channels().iter().zip(&self.known).enumerate() {
            let messages = counts.get(at).copied().unwrap_or(0);
            if let Some(topic) = topics.iter_mut().find(|topic| topic.name == channel.topic) {
                topic.messages = topic.messages.saturating_add(messages);
                continue;
            }
            topics.push(Topic {
                name: channel.topic.clone(),
                type_name: channel.message_type.clone(),
                message_type: match known {
                    Known::Type(message_type, _) => Some(*message_type),
                    Known::OtherVersion | Known::Unknown => None,
                },
                is_other_version: *known == Known::OtherVersion,
                messages,
            });
        }
        topics.sort_by(|one, other| one.name.cmp(&other.name));
        topics
    }

    /// Returns the topic `name`, whose messages must be readable as `value_type`; without a name, the only such
    /// topic.
    ///
    /// # Errors
    /// `NotFound` and `InvalidInput`, with the list of topics.
    pub fn topic_for(&self, value_type: ValueType, name: Option<&str>) -> Result<Topic> {
        let topics = self.topics();
        let path = self.path.display();
        if topics.is_empty() {
            let cut = if self.bag.is_complete() { "" } else { ": it is truncated or damaged" };
            return Err(Error::not_found(format!("{path} has no messages{cut}")));
        }
        let list = || topics.iter().map(|topic| topic.line(value_type)).collect::<String>();
        let type_name = value_type.name();
        if let Some(name) = name {
            let plain = |name: &str| name.trim_start_matches('/').to_owned();
            let found = topics.iter().find(|topic| plain(&topic.name) == plain(name));
            let found = found.ok_or_else(|| {
                Error::not_found(format!("{path} has no topic {name:?}; its topics are{}", list()))
            })?;
            return if found.fits(value_type) {
                Ok(found.clone())
            } else {
                Err(Error::invalid_input(format!(
                    "{} of {path} ({}) cannot be read as {type_name}; its topics are{}",
                    found.name,
                    found.type_name,
                    list()
                )))
            };
        }
        let fitting: Vec<_> = topics.iter().filter(|topic| topic.fits(value_type)).collect();
        let filled: Vec<_> = fitting.iter().filter(|topic| topic.messages > 0).collect();
        match (&filled[..], &fitting[..]) {
            ([only], _) => Ok((**only).clone()),
            ([], [only]) => Ok((*only).clone()),
            ([], []) => Err(Error::not_found(format!(
                "no topic of {path} can be read as {type_name} ({}); its topics are{}",
                names(value_type),
                list()
            ))),
            _ => Err(Error::invalid_input(format!(
                "several topics of {path} can be read as {type_name}; choose one of them{}",
                list()
            ))),
        }
    }

    /// Decodes a message of this recording.
    ///
    /// # Errors
    /// `Unsupported` for a type or encoding that OpenDR does not support, `Format` for bytes that are not such a
    /// message.
    pub fn decode(&self, message: &RecordedMessage) -> Result<Message> {
        decode(&self.known, self.bag.channels(), message)
    }

    pub(crate) fn known(&self) -> &[Known] {
        &self.known
    }
}

pub(crate) fn decode(
    known: &[Known],
    channels: &[opendr_bags::Channel],
    message: &RecordedMessage,
) -> Result<Message> {
    let (known, channel) = (known.get(message.channel), channels.get(message.channel));
    match (known, channel) {
        (Some(known), Some(channel)) => known.decode(channel, message),
        _ => Err(Error::invalid_input("the message is of another recording")),
    }
}

/// Returns the names of the messages that represent a type.
fn names(value_type: ValueType) -> String {
    let types = opendr_ros_bridge::message_types(value_type);
    types.map(MessageType::ros2_name).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn folders_of_other_things_are_no_recordings() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        assert!(
            is_recording(&path("a.BAG")) && is_recording(&path("a.mcap")) && !is_recording(&path("a.png"))
        );
        assert!(!is_recording(folder.path()));
        fs::write(path("a.mcap"), "").unwrap();
        assert!(is_recording(folder.path()));
        fs::write(path("metadata.yaml"), "license: CC-BY\n").unwrap();
        assert!(!is_recording(folder.path()));
        fs::write(path("metadata.yaml"), "rosbag2_bagfile_information:\n  version: 5\n").unwrap();
        assert!(is_recording(folder.path()));
    }
}
