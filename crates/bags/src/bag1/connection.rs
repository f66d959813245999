//! Connections, which are the channels of this crate.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use opendr_engine::{Error, Result};

use super::record::{Header, named};
use crate::channel::{Channel, Encoding};
use crate::storage::Summary;

/// Channel indices by connection number of the bag.
#[derive(Default)]
pub(super) struct Connections(HashMap<u32, usize>);

impl Connections {
    /// Adds the connection of a record; a record with a known number is ignored.
    pub fn add(&mut self, summary: &mut Summary, header: &Header, data: &[u8]) -> Result<()> {
        let number = header.connection.ok_or_else(|| Error::format("a connection has no number"))?;
        if let Entry::Vacant(entry) = self.0.entry(number) {
            entry.insert(summary.add(channel(header, data)?));
        }
        Ok(())
    }

    pub fn channel(&self, number: Option<u32>) -> Result<usize> {
        let number = number.ok_or_else(|| Error::format("a message has no connection"))?;
        let unknown = || {
            Error::format(format!("a message refers to connection {number}, which the bag does not define"))
        };
        self.0.get(&number).copied().ok_or_else(unknown)
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }
}

fn channel(header: &Header, data: &[u8]) -> Result<Channel> {
    let text = |value: &[u8]| String::from_utf8_lossy(value).into_owned();
    let mut channel = Channel::new(text(header.topic.unwrap_or_default()), "", Encoding::Ros1);
    for field in named(data) {
        let (name, value) = field?;
        match name {
            b"topic" if channel.topic.is_empty() => channel.topic = text(value),
            b"type" => channel.message_type = text(value),
            // ROS 1 writes `*` for any type.
            b"md5sum" => channel.type_hash = Some(text(value)).filter(|hash| hash != "*"),
            b"message_definition" => channel = channel.with_definition(text(value)),
            b"callerid" => channel.caller_id = Some(text(value)),
            b"latching" => channel.is_latching = value == b"1",
            _ => {}
        }
    }
    // The definition of an empty type is empty, but its hash is known.
    channel.definition =
        channel.definition.filter(|definition| !definition.text.is_empty() || channel.type_hash.is_some());
    Ok(channel)
}
