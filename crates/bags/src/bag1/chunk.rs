//! Chunks: records of many messages, compressed together.

use bytes::Bytes;
use opendr_engine::{Error, Result};

use super::connection::Connections;
use super::op;
use super::record::{Header, Place, split};
use crate::chunked::Layout;
use crate::compression::decompress;
use crate::in_order::{Entry, Loaded};
use crate::source::{Source, Window};
use crate::storage::Summary;

impl Layout for Connections {
    fn chunk(source: &Source, offset: u64) -> Result<Bytes> {
        let place = Place::read(&mut Window::new(source), offset)?;
        let header = Header::parse(&place.header)?;
        if header.op != op::CHUNK {
            return Err(Error::format(format!(
                "the index points to a record of type {} instead of a chunk",
                header.op
            )));
        }
        let size = header.size.ok_or_else(|| Error::format("a chunk has no size"))?;
        let bytes = source.read(place.data, place.data_len)?;
        decompress(header.compression.unwrap_or(b"none"), bytes, u64::from(size))
    }

    fn read_channels(&mut self, records: &[u8], summary: &mut Summary) -> Result<()> {
        let mut at = 0;
        while at < records.len() {
            let (header, data) = split(records, at)?;
            at = data.end;
            if header.op == op::CONNECTION {
                self.add(summary, &header, records.get(data).unwrap_or_default())?;
            }
        }
        Ok(())
    }

    fn load(&self, bytes: Bytes, filter: impl Fn(usize, i64) -> bool) -> Result<Loaded> {
        let mut entries = Vec::new();
        let mut at = 0;
        while at < bytes.len() {
            let (header, data) = split(&bytes, at)?;
            at = data.end;
            if header.op != op::MESSAGE {
                continue;
            }
            let channel = self.channel(header.connection)?;
            let log_time_ns = header.time_ns.ok_or_else(|| Error::format("a message has no time"))?;
            if filter(channel, log_time_ns) {
                let (channel, start, end) = (channel as u32, data.start, data.end);
                entries.push(Entry { log_time_ns, publish_time_ns: None, channel, start, end });
            }
        }
        Ok(Loaded { bytes, entries })
    }
}
