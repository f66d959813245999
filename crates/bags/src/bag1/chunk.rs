//! Chunks: many messages' records, compressed as one.

use bytes::Bytes;
use opendr_engine::{Error, Result};

use super::connection::Connections;
use super::op;
use super::record::{Header, Place, split};
use crate::compression::decompress;
use crate::in_order::{Entry, Loaded};
use crate::source::{Source, Window};
use crate::storage::Summary;

/// Where messages are.
#[derive(Debug, Clone)]
pub(super) enum Stretch {
    /// A chunk's record.
    Chunk { offset: u64 },
    /// Records outside of chunks, which a recorder that was killed leaves behind.
    Loose { offset: u64, len: u64 },
}

impl Stretch {
    /// The records as bytes.
    pub fn read(&self, source: &Source) -> Result<Bytes> {
        match *self {
            Self::Loose { offset, len } => source.read(offset, len),
            Self::Chunk { offset } => {
                let place = Place::read(&mut Window::new(source), offset)?;
                records(source, &place)
            }
        }
    }
}

/// What is in the chunk whose header was read.
pub(super) fn records(source: &Source, place: &Place) -> Result<Bytes> {
    let header = Header::parse(&place.header)?;
    if header.op != op::CHUNK {
        return Err(Error::format(format!(
            "the index points to a record of kind {}, not a chunk",
            header.op
        )));
    }
    let size = header.size.ok_or_else(|| Error::format("a chunk without its size"))?;
    let bytes = source.read(place.data, place.data_len)?;
    decompress(header.compression.unwrap_or(b"none"), bytes, u64::from(size))
}

/// The messages among the records that `wanted` takes by channel and time.
pub(super) fn load(
    bytes: Bytes,
    connections: &Connections,
    wanted: impl Fn(usize, i64) -> bool,
) -> Result<Loaded> {
    let mut entries = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let (header, data) = split(&bytes, at)?;
        at = data.end;
        if header.op != op::MESSAGE {
            continue;
        }
        let channel = connections.channel(header.connection)?;
        let log_time_ns = header.time_ns.ok_or_else(|| Error::format("a message without its time"))?;
        if wanted(channel, log_time_ns) {
            let channel = channel as u32;
            entries.push(Entry {
                log_time_ns,
                publish_time_ns: None,
                channel,
                start: data.start,
                end: data.end,
            });
        }
    }
    Ok(Loaded { bytes, entries })
}

/// Takes in the connections among the records.
pub(super) fn connections(bytes: &[u8], connections: &mut Connections, summary: &mut Summary) -> Result<()> {
    let mut at = 0;
    while at < bytes.len() {
        let (header, data) = split(bytes, at)?;
        if header.op == op::CONNECTION {
            connections.add(summary, &header, bytes.get(data.clone()).unwrap_or_default())?;
        }
        at = data.end;
    }
    Ok(())
}
