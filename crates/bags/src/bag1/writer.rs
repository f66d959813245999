//! Writer of bags that the tools of ROS 1 can play.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Seek, SeekFrom, Write};

use opendr_engine::{Error, Result};

use super::{BAG_HEADER, MAGIC, op};
use crate::channel::Channel;
use crate::compression::{Compression, compress};
use crate::storage::StorageWriter;

/// A bag being written. Chunks are written whole, followed by their indices.
pub(crate) struct Bag1Writer {
    file: File,
    compression: Compression,
    chunk_bytes: usize,
    connections: Vec<Connection>,
    chunk: Vec<u8>,
    /// Times and offsets of the messages of the open chunk, by connection.
    open: BTreeMap<u32, Vec<(u64, u32)>>,
    chunks: Vec<ChunkInfo>,
}

struct Connection {
    record: Vec<u8>,
    is_written: bool,
}

struct ChunkInfo {
    offset: u64,
    start: u64,
    end: u64,
    counts: Vec<(u32, u32)>,
}

impl Bag1Writer {
    pub fn new(mut file: File, compression: Compression, chunk_bytes: usize) -> Result<Self> {
        file.write_all(MAGIC)?;
        file.write_all(&bag_header(0, 0, 0))?;
        let (connections, chunk, open, chunks) = Default::default();
        Ok(Self { file, compression, chunk_bytes, connections, chunk, open, chunks })
    }

    fn write_chunk(&mut self) -> Result<()> {
        if self.chunk.is_empty() {
            return Ok(());
        }
        let offset = self.file.stream_position()?;
        let packed = compress(self.compression, &self.chunk)?;
        let name: &[u8] = if packed.is_some() { b"lz4" } else { b"none" };
        let size = small(self.chunk.len())?.to_le_bytes();
        let fields: [(&str, &[u8]); 3] = [("op", &[op::CHUNK]), ("compression", name), ("size", &size)];
        let data = packed.as_ref().unwrap_or(&self.chunk);
        self.file.write_all(&header(&fields, small(data.len())?)?)?;
        self.file.write_all(data)?;
        let open = std::mem::take(&mut self.open);
        let mut after = Vec::new();
        for (connection, messages) in &open {
            let count = small(messages.len())?;
            let fields: [(&str, &[u8]); 4] = [
                ("op", &[op::INDEX]),
                ("ver", &1_u32.to_le_bytes()),
                ("conn", &connection.to_le_bytes()),
                ("count", &count.to_le_bytes()),
            ];
            after.extend(header(&fields, small(messages.len() * 12)?)?);
            for (time, offset) in messages {
                after.extend(time.to_le_bytes());
                after.extend(offset.to_le_bytes());
            }
        }
        self.file.write_all(&after)?;
        let times = || open.values().flatten().map(|(time, _)| seconds_first(*time));
        let (start, end) = (times().min().unwrap_or(0), times().max().unwrap_or(0));
        let counts = open.iter().map(|(connection, messages)| (*connection, messages.len() as u32)).collect();
        self.chunks.push(ChunkInfo { offset, start: seconds_first(start), end: seconds_first(end), counts });
        self.chunk.clear();
        Ok(())
    }
}

impl StorageWriter for Bag1Writer {
    fn add_channel(&mut self, channel: &Channel) -> Result<()> {
        let number = small(self.connections.len())?.to_le_bytes();
        let latching: &[u8] = if channel.is_latching { b"1" } else { b"0" };
        let definition = channel.definition.as_ref().map_or("", |definition| &definition.text);
        let mut fields: Vec<(&str, &[u8])> = vec![
            ("topic", channel.topic.as_bytes()),
            ("type", channel.message_type.as_bytes()),
            // ROS 1 writes `*` for an unknown type.
            ("md5sum", channel.type_hash.as_deref().unwrap_or("*").as_bytes()),
            ("message_definition", definition.as_bytes()),
        ];
        if let Some(caller_id) = &channel.caller_id {
            fields.push(("callerid", caller_id.as_bytes()));
        }
        if channel.is_latching {
            fields.push(("latching", latching));
        }
        let data = named(&fields)?;
        let fields: [(&str, &[u8]); 3] =
            [("op", &[op::CONNECTION]), ("conn", &number), ("topic", channel.topic.as_bytes())];
        let mut record = header(&fields, small(data.len())?)?;
        record.extend(data);
        self.connections.push(Connection { record, is_written: false });
        Ok(())
    }

    fn write(&mut self, channel: usize, log_time_ns: i64, _: i64, bytes: &[u8]) -> Result<()> {
        let time = ros_time(log_time_ns)?;
        if self.chunk.len() as u64 + bytes.len() as u64 > u64::from(u32::MAX >> 1) {
            self.write_chunk()?;
        }
        let len = small(bytes.len())?;
        let Some(connection) = self.connections.get_mut(channel) else {
            return Err(Error::internal(format!("channel {channel} was not added")));
        };
        if !connection.is_written {
            self.chunk.extend(&connection.record);
            connection.is_written = true;
        }
        let offset = small(self.chunk.len())?;
        let number = small(channel)?;
        let fields: [(&str, &[u8]); 3] =
            [("op", &[op::MESSAGE]), ("conn", &number.to_le_bytes()), ("time", &time.to_le_bytes())];
        self.chunk.extend(header(&fields, len)?);
        self.chunk.extend(bytes);
        self.open.entry(number).or_default().push((time, offset));
        if self.chunk.len() >= self.chunk_bytes {
            self.write_chunk()?;
        }
        Ok(())
    }

    fn flush(&mut self) -> Result<()> {
        self.write_chunk()
    }

    fn finish(&mut self) -> Result<()> {
        self.write_chunk()?;
        let index_pos = self.file.stream_position()?;
        let mut index: Vec<u8> =
            self.connections.iter().flat_map(|connection| &connection.record).copied().collect();
        for chunk in &self.chunks {
            let fields: [(&str, &[u8]); 6] = [
                ("op", &[op::CHUNK_INFO]),
                ("ver", &1_u32.to_le_bytes()),
                ("chunk_pos", &chunk.offset.to_le_bytes()),
                ("start_time", &chunk.start.to_le_bytes()),
                ("end_time", &chunk.end.to_le_bytes()),
                ("count", &small(chunk.counts.len())?.to_le_bytes()),
            ];
            index.extend(header(&fields, small(chunk.counts.len() * 8)?)?);
            for (connection, count) in &chunk.counts {
                index.extend(connection.to_le_bytes());
                index.extend(count.to_le_bytes());
            }
        }
        self.file.write_all(&index)?;
        let header = bag_header(index_pos, small(self.connections.len())?, small(self.chunks.len())?);
        self.file.seek(SeekFrom::Start(MAGIC.len() as u64))?;
        self.file.write_all(&header)?;
        self.file.flush()?;
        Ok(())
    }
}

/// Packs a time: seconds in the low half, nanoseconds in the high half. In the file, the seconds come first.
fn ros_time(time_ns: i64) -> Result<u64> {
    let outside = || {
        Error::invalid_input(format!(
            "a message at {time_ns} ns: rosbag 1 supports times from 1 ns (its tools skip 0) to 2106; shift the clock"
        ))
    };
    let time = u64::try_from(time_ns).ok().filter(|time| *time > 0).ok_or_else(outside)?;
    let seconds = u32::try_from(time / 1_000_000_000).map_err(|_| outside())?;
    Ok(u64::from(seconds) | (time % 1_000_000_000) << 32)
}

/// Converts between a time as it is written and one that sorts by time.
fn seconds_first(time: u64) -> u64 {
    time.rotate_left(32)
}

fn small(len: usize) -> Result<u32> {
    u32::try_from(len).map_err(|_| {
        Error::invalid_input(format!("{len} bytes in one record: rosbag 1 supports at most {}", u32::MAX))
    })
}

fn named(fields: &[(&str, &[u8])]) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    for (name, value) in fields {
        bytes.extend(small(name.len() + 1 + value.len())?.to_le_bytes());
        bytes.extend(name.as_bytes());
        bytes.push(b'=');
        bytes.extend(*value);
    }
    Ok(bytes)
}

/// Returns a record up to its data, which has `data_len` bytes.
fn header(fields: &[(&str, &[u8])], data_len: u32) -> Result<Vec<u8>> {
    let named = named(fields)?;
    let mut bytes = Vec::with_capacity(named.len() + 8);
    bytes.extend(small(named.len())?.to_le_bytes());
    bytes.extend(named);
    bytes.extend(data_len.to_le_bytes());
    Ok(bytes)
}

fn bag_header(index_pos: u64, connections: u32, chunks: u32) -> Vec<u8> {
    let fields: [(&str, &[u8]); 4] = [
        ("op", &[op::BAG]),
        ("index_pos", &index_pos.to_le_bytes()),
        ("conn_count", &connections.to_le_bytes()),
        ("chunk_count", &chunks.to_le_bytes()),
    ];
    // The lengths are constant and small.
    let named = named(&fields).unwrap_or_default();
    let padding = BAG_HEADER - named.len();
    let mut bytes = Vec::with_capacity(BAG_HEADER + 8);
    bytes.extend((named.len() as u32).to_le_bytes());
    bytes.extend(named);
    bytes.extend((padding as u32).to_le_bytes());
    bytes.resize(BAG_HEADER + 8, b' ');
    bytes
}
