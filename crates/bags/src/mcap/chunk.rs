//! Chunks: many records, compressed as one.

use bytes::Bytes;
use opendr_engine::{Error, Result};

use super::channels::Channels;
use super::record::{Place, split, time_ns};
use super::{MESSAGE_HEADER, op};
use crate::compression::{LARGEST, decompress};
use crate::fields::Fields;
use crate::in_order::{Entry, Loaded};
use crate::source::{Source, Window};
use crate::storage::Summary;

/// Where messages are.
#[derive(Debug, Clone)]
pub(super) enum Stretch {
    /// A chunk's record.
    Chunk { offset: u64 },
    /// Records outside of chunks.
    Loose { offset: u64, len: u64 },
}

impl Stretch {
    /// The records as bytes.
    pub fn read(&self, source: &Source) -> Result<Bytes> {
        match *self {
            Self::Loose { offset, len } => source.read(offset, len),
            Self::Chunk { offset } => read_chunk(source, offset),
        }
    }
}

fn read_chunk(source: &Source, offset: u64) -> Result<Bytes> {
    let mut window = Window::new(source);
    let place = Place::read(&mut window, offset)?;
    if place.op != op::CHUNK {
        return Err(Error::format(format!("the index points to a record of kind {}, not a chunk", place.op)));
    }
    // Times, size, checksum and the compression's name fit into this.
    let head = window.read(place.body, place.len.min(256))?;
    let mut fields = Fields(&head);
    fields.take(16)?;
    let (size, checksum) = (fields.u64()?, fields.u32()?);
    let name = fields.sized()?;
    let len = fields.u64()?;
    let at = (head.len() - fields.0.len()) as u64;
    if len > place.len - at || len > LARGEST {
        return Err(Error::format(format!("a chunk of {} bytes is told to hold {len}", place.len)));
    }
    let bytes = decompress(name, source.read(place.body + at, len)?, size)?;
    if checksum != 0 && crc32fast::hash(&bytes) != checksum {
        return Err(Error::new(opendr_engine::ErrorKind::Integrity, "the chunk differs from its checksum"));
    }
    Ok(bytes)
}

/// The messages among the records that `wanted` takes by channel and time.
pub(super) fn load(bytes: Bytes, channels: &Channels, wanted: impl Fn(usize, i64) -> bool) -> Result<Loaded> {
    let mut entries = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let (op, body) = split(&bytes, at)?;
        at = body.end;
        if op != op::MESSAGE {
            continue;
        }
        let mut fields = Fields(bytes.get(body.clone()).unwrap_or_default());
        let channel = channels.index(fields.u16()?)?;
        fields.u32()?;
        let log_time_ns = time_ns(fields.u64()?)?;
        let publish_time_ns = i64::try_from(fields.u64()?).ok();
        if wanted(channel, log_time_ns) {
            let (start, end) = (body.start + MESSAGE_HEADER, body.end);
            entries.push(Entry { log_time_ns, publish_time_ns, channel: channel as u32, start, end });
        }
    }
    Ok(Loaded { bytes, entries })
}

/// Takes in the schemas and channels among the records.
pub(super) fn channels(bytes: &[u8], channels: &mut Channels, summary: &mut Summary) -> Result<()> {
    let mut at = 0;
    while at < bytes.len() {
        let (op, body) = split(bytes, at)?;
        at = body.end;
        let body = bytes.get(body).unwrap_or_default();
        match op {
            op::SCHEMA => channels.add_schema(body)?,
            op::CHANNEL => channels.add_channel(summary, body)?,
            _ => {}
        }
    }
    Ok(())
}
