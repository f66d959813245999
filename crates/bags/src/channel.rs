//! What a recording says about one stream of messages.

use std::fmt;

/// One stream of messages of one type. Several may share a topic (several publishers in ROS 1).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Channel {
    /// Topic name, e.g. `/camera/image_raw`.
    pub topic: String,
    /// `sensor_msgs/Image` with [`Encoding::Ros1`], `sensor_msgs/msg/Image` with [`Encoding::Cdr`].
    pub message_type: String,
    /// How the bytes of its messages are to be read.
    pub encoding: Encoding,
    /// The definition of the type and of all that it is made of, where the recording holds it.
    pub definition: Option<Definition>,
    /// The MD5 sum of a ROS 1 type, `RIHS01_...` of a ROS 2 type.
    pub type_hash: Option<String>,
    /// ROS 2: the publishers' quality of service as rosbag2 keeps it, a YAML list in text.
    pub qos: Option<String>,
    /// ROS 1: the publisher sends its last message to new subscribers.
    pub is_latching: bool,
    /// ROS 1: the name of the publishing node.
    pub caller_id: Option<String>,
}

impl Channel {
    /// A channel without definition, hash and what only one format keeps; the type's name is normalised.
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

    /// With a definition in the style of concatenated `.msg` files.
    #[must_use]
    pub fn with_definition(mut self, text: impl Into<String>) -> Self {
        self.definition = Some(Definition { language: Language::Msg, text: text.into() });
        self
    }

    /// With the MD5 sum (ROS 1) or `RIHS01_...` (ROS 2) of the type.
    #[must_use]
    pub fn with_type_hash(mut self, hash: impl Into<String>) -> Self {
        self.type_hash = Some(hash.into());
        self
    }
}

/// How the bytes of messages are to be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Encoding {
    /// ROS 1's own serialisation.
    Ros1,
    /// ROS 2's: CDR with its four bytes of encapsulation header, as recordings keep it.
    Cdr,
    /// Another one of an MCAP file by its name there, e.g. `json`: read as bytes, never written.
    Other(String),
}

impl Encoding {
    /// From MCAP's `message_encoding` or rosbag2's `serialization_format`.
    pub(crate) fn from_name(name: &str) -> Self {
        match name {
            "ros1" => Self::Ros1,
            "cdr" => Self::Cdr,
            other => Self::Other(other.to_owned()),
        }
    }
}

/// The name that MCAP uses: `ros1`, `cdr` or the other one's.
impl fmt::Display for Encoding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ros1 => "ros1",
            Self::Cdr => "cdr",
            Self::Other(name) => name,
        })
    }
}

/// A type's definition.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Definition {
    /// What the text is written in.
    pub language: Language,
    /// The text; the types that the first one is made of follow it after lines of `=`.
    pub text: String,
}

/// What definitions of types are written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// ROS `.msg` files.
    Msg,
    /// OMG IDL, which some ROS 2 packages have alone.
    Idl,
}

/// `pkg/Type` for ROS 1 and `pkg/msg/Type` for ROS 2; names of other shapes are left as they are.
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
