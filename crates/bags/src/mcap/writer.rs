//! Writer of MCAP files: chunks with message indices, a summary at the end.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Seek, Write};

use opendr_engine::{Error, Result};

use super::record::Put;
use super::{FOOTER, MAGIC, op};
use crate::channel::{Channel, Encoding, Language};
use crate::compression::{Compression, compress};
use crate::storage::StorageWriter;

/// A file being written. Chunks are written whole.
pub(crate) struct McapWriter {
    file: File,
    compression: Compression,
    chunk_bytes: usize,
    is_started: bool,
    /// Schemas; their ids start at 1.
    schemas: Vec<Schema>,
    channels: Vec<ChannelState>,
    chunk: Vec<u8>,
    /// Times and offsets of the messages of the open chunk, by channel.
    open: BTreeMap<u16, Vec<(u64, u64)>>,
    chunk_indices: Vec<Vec<u8>>,
    metadata_indices: Vec<Vec<u8>>,
    span: Option<(u64, u64)>,
}

struct Schema {
    name: String,
    language: &'static str,
    text: String,
}

struct ChannelState {
    /// Types and bodies of its records, first the schema's, then the channel's.
    records: [(u8, Vec<u8>); 2],
    is_written: bool,
    messages: u64,
}

impl McapWriter {
    pub fn new(file: File, compression: Compression, chunk_bytes: usize) -> Self {
        let (schemas, channels, chunk, open, chunk_indices, metadata_indices) = Default::default();
        Self {
            file,
            compression,
            chunk_bytes,
            is_started: false,
            schemas,
            channels,
            chunk,
            open,
            chunk_indices,
            metadata_indices,
            span: None,
        }
    }

    /// Writes the header of the file, whose profile states the kind of messages.
    fn start(&mut self, profile: &str) -> Result<()> {
        if !self.is_started {
            self.is_started = true;
            let mut body = Vec::new();
            body.text(profile);
            body.text(concat!("opendr ", env!("CARGO_PKG_VERSION")));
            let mut bytes = MAGIC.to_vec();
            bytes.record(op::HEADER, &body);
            self.file.write_all(&bytes)?;
        }
        Ok(())
    }

    /// Adds named texts about the file, e.g. the metadata of rosbag2.
    pub fn add_metadata(&mut self, name: &str, texts: &BTreeMap<String, String>) -> Result<()> {
        self.start("ros2")?;
        self.write_chunk()?;
        let mut body = Vec::new();
        body.text(name);
        body.texts(texts);
        let mut bytes = Vec::new();
        bytes.record(op::METADATA, &body);
        let mut index = self.file.stream_position()?.to_le_bytes().to_vec();
        index.extend((bytes.len() as u64).to_le_bytes());
        index.text(name);
        self.metadata_indices.push(index);
        self.file.write_all(&bytes)?;
        Ok(())
    }

    fn schema(&mut self, channel: &Channel) -> Result<(u16, Vec<u8>)> {
        let language = match channel.definition.as_ref().map(|definition| definition.language) {
            None => "",
            Some(Language::Idl) => "ros2idl",
            Some(Language::Msg) if channel.encoding == Encoding::Ros1 => "ros1msg",
            Some(Language::Msg) => "ros2msg",
        };
        let text = channel.definition.as_ref().map_or("", |definition| &definition.text);
        let known = self.schemas.iter().position(|schema| {
            schema.name == channel.message_type && schema.language == language && schema.text == text
        });
        let at = known.unwrap_or_else(|| {
            self.schemas.push(Schema { name: channel.message_type.clone(), language, text: text.to_owned() });
            self.schemas.len() - 1
        });
        let number =
            u16::try_from(at + 1).map_err(|_| Error::invalid_input("MCAP supports at most 65535 types"))?;
        let mut body = number.to_le_bytes().to_vec();
        body.text(&channel.message_type);
        body.text(language);
        body.text(text);
        Ok((number, body))
    }

    fn write_chunk(&mut self) -> Result<()> {
        let open = std::mem::take(&mut self.open);
        let times = || open.values().flatten().map(|(time, _)| *time);
        let (Some(start), Some(end)) = (times().min(), times().max()) else { return Ok(()) };
        let packed = compress(self.compression, &self.chunk)?;
        let name = if packed.is_some() { "lz4" } else { "" };
        let data = packed.as_ref().unwrap_or(&self.chunk);
        let mut head =
            [start.to_le_bytes(), end.to_le_bytes(), (self.chunk.len() as u64).to_le_bytes()].concat();
        head.extend(crc32fast::hash(&self.chunk).to_le_bytes());
        head.text(name);
        head.extend((data.len() as u64).to_le_bytes());
        let offset = self.file.stream_position()?;
        let mut bytes = vec![op::CHUNK];
        bytes.extend(((head.len() + data.len()) as u64).to_le_bytes());
        bytes.extend(head);
        self.file.write_all(&bytes)?;
        self.file.write_all(data)?;
        let len = (bytes.len() + data.len()) as u64;

        let mut indices = Vec::new();
        let mut offsets = Vec::new();
        for (channel, messages) in &open {
            offsets.extend(channel.to_le_bytes());
            offsets.extend((offset + len + indices.len() as u64).to_le_bytes());
            let mut body = channel.to_le_bytes().to_vec();
            body.extend((messages.len() as u32 * 16).to_le_bytes());
            body.extend(
                messages.iter().flat_map(|(time, at)| [time.to_le_bytes(), at.to_le_bytes()].concat()),
            );
            indices.record(op::MESSAGE_INDEX, &body);
        }
        self.file.write_all(&indices)?;

        let mut index = [start, end, offset, len].map(u64::to_le_bytes).concat();
        index.extend((offsets.len() as u32).to_le_bytes());
        index.extend(offsets);
        index.extend((indices.len() as u64).to_le_bytes());
        index.text(name);
        index.extend((data.len() as u64).to_le_bytes());
        index.extend((self.chunk.len() as u64).to_le_bytes());
        self.chunk_indices.push(index);
        let (first, last) = self.span.unwrap_or((start, end));
        self.span = Some((first.min(start), last.max(end)));
        self.chunk.clear();
        Ok(())
    }

    fn statistics(&self) -> Vec<u8> {
        let messages: u64 = self.channels.iter().map(|channel| channel.messages).sum();
        let (start, end) = self.span.unwrap_or_default();
        let mut body = messages.to_le_bytes().to_vec();
        body.extend((self.schemas.len() as u16).to_le_bytes());
        body.extend((self.channels.len() as u32).to_le_bytes());
        body.extend(0_u32.to_le_bytes());
        body.extend((self.metadata_indices.len() as u32).to_le_bytes());
        body.extend((self.chunk_indices.len() as u32).to_le_bytes());
        body.extend(start.to_le_bytes());
        body.extend(end.to_le_bytes());
        let counts = self.channels.iter().map(|channel| channel.messages).enumerate();
        let counts: Vec<u8> = counts
            .filter(|(_, messages)| *messages > 0)
            .flat_map(|(at, messages)| (at as u16).to_le_bytes().into_iter().chain(messages.to_le_bytes()))
            .collect();
        body.extend((counts.len() as u32).to_le_bytes());
        body.extend(counts);
        body
    }
}

impl StorageWriter for McapWriter {
    fn add_channel(&mut self, channel: &Channel) -> Result<()> {
        self.start(if channel.encoding == Encoding::Ros1 { "ros1" } else { "ros2" })?;
        let number = u16::try_from(self.channels.len())
            .map_err(|_| Error::invalid_input("MCAP supports at most 65536 channels"))?;
        let (schema, schema_body) = self.schema(channel)?;
        let hash = if channel.encoding == Encoding::Ros1 { "md5sum" } else { "topic_type_hash" };
        let latching = channel.is_latching.then(|| "1".to_owned());
        let metadata = [
            (hash, channel.type_hash.clone()),
            ("offered_qos_profiles", channel.qos.clone()),
            ("callerid", channel.caller_id.clone()),
            ("latching", latching),
        ];
        let metadata =
            metadata.into_iter().filter_map(|(key, value)| Some((key.to_owned(), value?))).collect();
        let mut body = number.to_le_bytes().to_vec();
        body.extend(schema.to_le_bytes());
        body.text(&channel.topic);
        body.text(&channel.encoding.to_string());
        body.texts(&metadata);
        let records = [(op::SCHEMA, schema_body), (op::CHANNEL, body)];
        self.channels.push(ChannelState { records, is_written: false, messages: 0 });
        Ok(())
    }

    fn write(&mut self, channel: usize, log_time_ns: i64, publish_time_ns: i64, bytes: &[u8]) -> Result<()> {
        let unsigned = |time: i64| {
            u64::try_from(time).map_err(|_| {
                Error::invalid_input(format!("a message at {time} ns: MCAP supports no times before 1970"))
            })
        };
        let (log, publish) = (unsigned(log_time_ns)?, unsigned(publish_time_ns)?);
        let number = channel as u16;
        let Some(state) = self.channels.get_mut(channel) else {
            return Err(Error::internal(format!("channel {channel} was not added")));
        };
        if !state.is_written {
            state.is_written = true;
            state.records.iter().for_each(|(op, body)| self.chunk.record(*op, body));
        }
        self.open.entry(number).or_default().push((log, self.chunk.len() as u64));
        self.chunk.push(op::MESSAGE);
        self.chunk.extend((super::MESSAGE_HEADER as u64 + bytes.len() as u64).to_le_bytes());
        self.chunk.extend(number.to_le_bytes());
        self.chunk.extend((state.messages as u32).to_le_bytes());
        self.chunk.extend(log.to_le_bytes());
        self.chunk.extend(publish.to_le_bytes());
        self.chunk.extend(bytes);
        state.messages += 1;
        if self.chunk.len() >= self.chunk_bytes { self.write_chunk() } else { Ok(()) }
    }

    fn flush(&mut self) -> Result<()> {
        self.write_chunk()
    }

    fn finish(&mut self) -> Result<()> {
        self.start("")?;
        self.write_chunk()?;
        let mut bytes = Vec::new();
        // A checksum of 0 means none: each chunk has its own.
        bytes.record(op::DATA_END, &0_u32.to_le_bytes());
        self.file.write_all(&bytes)?;

        let start = self.file.stream_position()?;
        let statistics = self.statistics();
        let records = |at: usize| self.channels.iter().filter_map(move |channel| channel.records.get(at));
        let mut schemas: Vec<_> = records(0).map(|(_, body)| body).collect();
        schemas.sort_unstable();
        schemas.dedup();
        let groups: [(u8, Vec<&Vec<u8>>); 5] = [
            (op::SCHEMA, schemas),
            (op::CHANNEL, records(1).map(|(_, body)| body).collect()),
            (op::STATISTICS, vec![&statistics]),
            (op::CHUNK_INDEX, self.chunk_indices.iter().collect()),
            (op::METADATA_INDEX, self.metadata_indices.iter().collect()),
        ];
        let mut summary = Vec::new();
        let mut offsets = Vec::new();
        for (op, bodies) in groups.iter().filter(|(_, bodies)| !bodies.is_empty()) {
            let from = summary.len() as u64;
            bodies.iter().for_each(|body| summary.record(*op, body));
            let mut body = vec![*op];
            body.extend((start + from).to_le_bytes());
            body.extend((summary.len() as u64 - from).to_le_bytes());
            offsets.record(op::SUMMARY_OFFSET, &body);
        }
        let offsets_start = start + summary.len() as u64;
        summary.extend(offsets);
        summary.push(op::FOOTER);
        summary.extend((FOOTER - 9).to_le_bytes());
        summary.extend(start.to_le_bytes());
        summary.extend(offsets_start.to_le_bytes());
        summary.extend(crc32fast::hash(&summary).to_le_bytes());
        summary.extend(MAGIC);
        self.file.write_all(&summary)?;
        self.file.flush()?;
        Ok(())
    }
}
