//! Message types, and their names, hashes and definitions.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::str::FromStr;

use opendr_engine::{Error, Result};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::{Message, MessageType, cdr};

/// Wire format of messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum WireFormat {
    /// ROS 1's format: little-endian, without padding.
    Ros1,
    /// ROS 2's format: CDR with its header of 4 bytes, as in DDS and recordings.
    Cdr,
}

/// A message type in ROS 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ros1Type {
    /// Name, such as `"sensor_msgs/Image"`.
    pub name: &'static str,
    /// md5 sum, which nodes compare at the connection.
    pub md5sum: &'static str,
    pub(crate) text: &'static str,
    pub(crate) uses: &'static [&'static str],
}

/// A message struct.
pub trait RosMessage:
    Clone + Default + PartialEq + Serialize + DeserializeOwned + Into<Message> + Send + Sync + 'static
{
    /// Type of the message.
    const TYPE: MessageType;

    /// Writes the message in ROS 1's format.
    ///
    /// # Errors
    /// `Unsupported` when ROS 1 does not have the message.
    fn to_ros1(&self) -> Result<Vec<u8>>;

    /// Reads a message in ROS 1's format.
    ///
    /// # Errors
    /// `Format` for bytes of another form; `Unsupported` when ROS 1 does not have the message.
    fn from_ros1(bytes: &[u8]) -> Result<Self>;
}

impl MessageType {
    /// Returns the definition with those of all contained types, in the syntax of `wire`, as in recordings and ROS 1 connections.
    ///
    /// # Errors
    /// `Unsupported` when ROS 1 does not have the message.
    pub fn definition(self, wire: WireFormat) -> Result<String> {
        let (text, uses) = match wire {
            WireFormat::Cdr => self.ros2_text(),
            WireFormat::Ros1 => {
                let known = self.ros1().ok_or_else(|| not_in_ros1(self))?;
                (known.text, known.uses)
            }
        };
        let mut whole = text.to_owned();
        for name in uses {
            let used = Self::ALL.iter().find_map(|used| match wire {
                WireFormat::Cdr => {
                    let (package, short) = used.package_and_name();
                    (name.split_once('/') == Some((package, short))).then(|| used.ros2_text().0)
                }
                WireFormat::Ros1 => used.ros1().filter(|known| known.name == *name).map(|known| known.text),
            });
            let _ = write!(whole, "{}\nMSG: {name}\n{}", "=".repeat(80), used.unwrap_or_default());
        }
        Ok(whole)
    }
}

impl Message {
    /// Writes the message as bytes.
    ///
    /// # Errors
    /// `Unsupported` when ROS 1 does not have the message.
    pub fn to_bytes(&self, wire: WireFormat) -> Result<Vec<u8>> {
        match wire {
            WireFormat::Cdr => cdr::cdr_from_message(self),
            WireFormat::Ros1 => self.to_ros1(),
        }
    }

    /// Reads a message of a type.
    ///
    /// # Errors
    /// `Format` for bytes of another form; `Unsupported` when ROS 1 does not have the message.
    pub fn from_bytes(message_type: MessageType, wire: WireFormat, bytes: &[u8]) -> Result<Self> {
        match wire {
            WireFormat::Cdr => cdr::seeded_message_from_cdr(message_type, bytes),
            WireFormat::Ros1 => Self::from_ros1(message_type, bytes),
        }
    }
}

/// Parses the name of a type in ROS 2 (`sensor_msgs/msg/Image`) or ROS 1 (`sensor_msgs/Image`).
impl FromStr for MessageType {
    type Err = Error;

    /// # Errors
    /// `NotFound` for an unknown message type.
    fn from_str(name: &str) -> Result<Self> {
        let ros1_name: Cow<'_, str> = name.replacen("/msg/", "/", 1).into();
        Self::ALL
            .iter()
            .copied()
            .find(|known| {
                known.ros2_name() == name
                    || known.ros1().is_some_and(|known| known.name == ros1_name)
                    || ros1_name.split_once('/') == Some(known.package_and_name())
            })
            .ok_or_else(|| Error::not_found(format!("OpenDR does not support the message type {name:?}")))
    }
}

#[cold]
pub(crate) fn wrong_type(given: MessageType, wanted: MessageType) -> Error {
    Error::invalid_input(format!("the message has type {}, not {}", given.ros2_name(), wanted.ros2_name()))
}

#[cold]
pub(crate) fn not_in_ros1(message_type: MessageType) -> Error {
    Error::unsupported(format!("ROS 1 has no message {}", message_type.ros2_name()))
}
