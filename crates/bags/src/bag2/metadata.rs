//! `metadata.yaml`: reads versions 1 to 9, writes version 8.

use std::fmt::Write as _;
use std::path::Path;

use opendr_engine::{Error, Result, ResultExt};
use serde::Deserialize;

use crate::channel::Channel;
use crate::storage::Summary;

/// The fields of `metadata.yaml` that the files themselves do not contain.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Metadata {
    pub relative_file_paths: Vec<String>,
    pub topics_with_message_count: Vec<TopicCount>,
    pub compression_format: Option<String>,
    pub compression_mode: Option<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct TopicCount {
    pub topic_metadata: Topic,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Topic {
    pub name: String,
    #[serde(rename = "type")]
    pub message_type: String,
    pub type_description_hash: Option<String>,
}

#[derive(Deserialize)]
struct Root {
    rosbag2_bagfile_information: Metadata,
}

/// Largest size of a metadata file, in bytes.
const MAX_BYTES: u64 = 64 << 20;

impl Metadata {
    pub fn read(path: &Path) -> Result<Self> {
        let read = || {
            let size = std::fs::metadata(path)?.len();
            if size > MAX_BYTES {
                return Err(Error::format(format!("{size} bytes: the limit for metadata is {MAX_BYTES}")));
            }
            Self::from_yaml(&std::fs::read_to_string(path)?)
        };
        read().context(|| format!("reading {}", path.display()))
    }

    pub fn from_yaml(text: &str) -> Result<Self> {
        let root: Root = serde_saphyr::from_str(text)
            .map_err(|error| Error::format("not the metadata of rosbag2").with_source(error.to_string()))?;
        Ok(root.rosbag2_bagfile_information)
    }

    /// Returns the hash of the type of a channel, if the metadata has it.
    pub fn type_hash(&self, channel: &Channel) -> Option<String> {
        let topics = self.topics_with_message_count.iter().map(|topic| &topic.topic_metadata);
        let mut same =
            topics.filter(|topic| topic.name == channel.topic && topic.message_type == channel.message_type);
        same.next()?.type_description_hash.clone().filter(|hash| !hash.is_empty())
    }

    /// Returns whether the recording is compressed by `mode` (`file` or `message`).
    pub fn is_compressed_by(&self, mode: &str) -> bool {
        self.compression_mode.as_deref().is_some_and(|own| own.eq_ignore_ascii_case(mode))
    }
}

/// Version that is written: the last with the quality of service as text, which ROS 2 reads since Humble.
pub(super) const VERSION: u32 = 8;

/// Returns the metadata of a recording with one file without the outermost key, as the storages keep it.
pub(super) fn to_yaml(storage: &str, file: &str, summary: &Summary) -> String {
    let (start, end) = summary.span.unwrap_or_default();
    let duration = end.saturating_sub(start);
    let count: u64 = summary.counts.iter().sum();
    let mut yaml = format!(
        "version: {VERSION}\nstorage_identifier: {storage}\nduration:\n  nanoseconds: {duration}\n\
         starting_time:\n  nanoseconds_since_epoch: {start}\nmessage_count: {count}\n"
    );
    yaml += if summary.channels.is_empty() {
        "topics_with_message_count: []\n"
    } else {
        "topics_with_message_count:\n"
    };
    for (channel, count) in summary.channels.iter().zip(&summary.counts) {
        let text = |text: &Option<String>| quoted(text.as_deref().unwrap_or_default());
        // Writing to a string cannot fail.
        let _ = write!(
            yaml,
            "  - topic_metadata:\n      name: {}\n      type: {}\n      serialization_format: cdr\n      \
             offered_qos_profiles: {}\n      type_description_hash: {}\n    message_count: {count}\n",
            quoted(&channel.topic),
            quoted(&channel.message_type),
            text(&channel.qos),
            text(&channel.type_hash),
        );
    }
    let file = quoted(file);
    yaml + &format!(
        "compression_format: \"\"\ncompression_mode: \"\"\nrelative_file_paths:\n  - {file}\nfiles:\n  \
         - path: {file}\n    starting_time:\n      nanoseconds_since_epoch: {start}\n    duration:\n      \
         nanoseconds: {duration}\n    message_count: {count}\ncustom_data: ~\nros_distro: opendr\n"
    )
}

/// Returns the content of `metadata.yaml`.
pub(super) fn document(information: &str) -> String {
    let mut yaml = "rosbag2_bagfile_information:\n".to_owned();
    for line in information.lines() {
        yaml += "  ";
        yaml += line;
        yaml.push('\n');
    }
    yaml
}

/// Returns a double-quoted scalar.
fn quoted(text: &str) -> String {
    let mut out = "\"".to_owned();
    for character in text.chars() {
        match character {
            '"' => out += "\\\"",
            '\\' => out += "\\\\",
            '\n' => out += "\\n",
            '\t' => out += "\\t",
            // Control characters, and the line breaks of YAML 1.1 besides the line feed.
            c if c.is_control() || matches!(c, '\u{2028}' | '\u{2029}' | '\u{feff}') => {
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out + "\""
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::channel::Encoding;

    #[test]
    fn what_is_written_is_read() {
        let odd = "/a\"b\\c\n\u{85}\u{7}é: - #";
        let mut channel = Channel::new(odd, "a/msg/B", Encoding::Cdr).with_type_hash("RIHS01_ab");
        channel.qos = Some("- history: 3\n  depth: 0\n".into());
        let mut summary = Summary { span: Some((5, 7)), ..Summary::default() };
        summary.add(channel.clone());
        let yaml = document(&to_yaml("sqlite3", "bag_0.db3", &summary));
        let read = Metadata::from_yaml(&yaml).unwrap();
        assert_eq!(read.relative_file_paths, ["bag_0.db3"]);
        assert_eq!(read.type_hash(&channel).unwrap(), "RIHS01_ab");
        assert!(!read.is_compressed_by("file"));
    }

    #[test]
    fn a_bomb_of_aliases_is_refused() {
        let mut yaml = "a: &a [x, x, x, x, x, x, x, x, x, x]\n".to_owned();
        for (name, before) in "bcdefghij".chars().zip("abcdefghi".chars()) {
            let many = vec![format!("*{before}"); 10].join(", ");
            yaml += &format!("{name}: &{name} [{many}]\n");
        }
        yaml += "rosbag2_bagfile_information: {relative_file_paths: *j}\n";
        assert!(Metadata::from_yaml(&yaml).is_err());
        assert!(Metadata::from_yaml(&"[".repeat(100_000)).is_err());
        assert!(Metadata::from_yaml("version: 4").is_err());
    }
}
