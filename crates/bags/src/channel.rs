//! Channels of a recording.

use std::fmt;

/// A sequence of messages of one type. Several channels may share a topic (several publishers in ROS 1).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Channel {
    /// Topic name, e.g. `/camera/image_raw`.
    pub topic: String,
    /// Type name: `sensor_msgs/Image` with [`Encoding::Ros1`], `sensor_msgs/msg/Image` with [`Encoding::Cdr`].
    pub message_type: String,
    /// Encoding of the messages.
    pub encoding: Encoding,
    /// Definition of the type and of the types it contains, if the recording has it.
    pub definition: Option<Definition>,
    /// MD5 sum of a ROS 1 type, `RIHS01_...` of a ROS 2 type.
    pub type_hash: Option<String>,
    /// ROS 2: quality of service of the publishers, as the YAML text of rosbag2.
    pub qos: Option<String>,
    /// ROS 1: whether the publisher sends its last message to new subscribers.
    pub is_latching: bool,
    /// ROS 1: name of the publishing node.
    pub caller_id: Option<String>,
}

impl Channel {
    /// Creates a channel with a normalised type name; the other fields are empty.
    pub fn new(topic: impl Into<String>, message_type: impl AsRef<str>, encoding: Encoding) -> Self {
        Self {
            topic: topic.into(),
            message_type: normal_type(message_type.as_ref(), &encoding),
            encoding,
            definition: None,
            type_hash: None,
            qos: None,
            is_latching: false,
            caller_id: None,
        }
    }

    /// Sets the definition, as concatenated `.msg` files.
    #[must_use]
    pub fn with_definition(mut self, text: impl Into<String>) -> Self {
        self.definition = Some(Definition { language: Language::Msg, text: text.into() });
        self
    }

    /// Sets the hash of the type: the MD5 sum (ROS 1) or `RIHS01_...` (ROS 2).
    #[must_use]
    pub fn with_type_hash(mut self, hash: impl Into<String>) -> Self {
        self.type_hash = Some(hash.into());
        self
    }
}

/// Encoding of messages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Encoding {
    /// The serialisation of ROS 1.
    Ros1,
    /// The serialisation of ROS 2: CDR with its four bytes of encapsulation header.
    Cdr,
    /// Another encoding of an MCAP file by its name, e.g. `json`. Its messages are read as bytes and cannot be
    /// written.
    Other(String),
}

impl Encoding {
    /// Returns the encoding for MCAP's `message_encoding` or rosbag2's `serialization_format`.
    pub(crate) fn from_name(name: &str) -> Self {
        match name {
            "ros1" => Self::Ros1,
            "cdr" => Self::Cdr,
            other => Self::Other(other.to_owned()),
        }
    }
}

/// Writes the name of MCAP: `ros1`, `cdr` or the name of the other encoding.
impl fmt::Display for Encoding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ros1 => "ros1",
            Self::Cdr => "cdr",
            Self::Other(name) => name,
        })
    }
}

/// Definition of a message type.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Definition {
    /// Language of the text.
    pub language: Language,
    /// Text of the definition; the contained types follow, separated by lines of `=`.
    pub text: String,
}

/// Language of a type definition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// ROS `.msg` files.
    Msg,
    /// OMG IDL, the only definition that some packages of ROS 2 have.
    Idl,
}

/// Returns `pkg/Type` for ROS 1 and `pkg/msg/Type` for ROS 2; other names are returned unchanged.
pub(crate) fn normal_type(name: &str, encoding: &Encoding) -> String {
    let parts: Vec<_> = name.split('/').collect();
    match (encoding, &parts[..]) {
        (Encoding::Ros1, [package, "msg", name]) => format!("{package}/{name}"),
        (Encoding::Cdr, [package, name]) => format!("{package}/msg/{name}"),
        _ => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_are_named_as_their_ros_names_them() {
        let named = |name, encoding| Channel::new("/a", name, encoding).message_type;
        assert_eq!(named("sensor_msgs/msg/Image", Encoding::Ros1), "sensor_msgs/Image");
        assert_eq!(named("sensor_msgs/Image", Encoding::Cdr), "sensor_msgs/msg/Image");
        assert_eq!(named("a/srv/B_Request", Encoding::Cdr), "a/srv/B_Request");
        assert_eq!(named("foxglove.Grid", Encoding::Other("protobuf".into())), "foxglove.Grid");
    }
}
