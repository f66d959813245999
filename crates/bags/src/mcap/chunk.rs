//! Chunks: many records, compressed together.

use bytes::Bytes;
use opendr_engine::{Error, ErrorKind, Result};

use super::channels::Channels;
use super::record::{Place, split, time_ns};
use super::{MESSAGE_HEADER, op};
use crate::chunked::Layout;
use crate::compression::{MAX_BYTES, decompress};
use crate::fields::Fields;
use crate::in_order::{Entry, Loaded};
use crate::source::{Source, Window};
use crate::storage::Summary;

impl Layout for Channels {
    fn chunk(source: &Source, offset: u64) -> Result<Bytes> {
        let mut window = Window::new(source);
        let place = Place::read(&mut window, offset)?;
        if place.op != op::CHUNK {
            return Err(Error::format(format!(
                "the index points to a record of type {} instead of a chunk",
                place.op
            )));
        }
        // The times, size, checksum and name of the compression fit into this.
        let head = window.read(place.body, place.len.min(256))?;
        let mut fields = Fields(&head);
        fields.take(16)?;
        let (size, checksum) = (fields.u64()?, fields.u32()?);
        let name = fields.sized()?;
        let len = fields.u64()?;
        let at = (head.len() - fields.0.len()) as u64;
        if len > place.len - at || len > MAX_BYTES {
            return Err(Error::format(format!("a chunk of {} bytes states {len} bytes of data", place.len)));
        }
        let bytes = decompress(name, source.read(place.body + at, len)?, size)?;
        if checksum != 0 && crc32fast::hash(&bytes) != checksum {
            return Err(Error::new(ErrorKind::Integrity, "the chunk does not match its checksum"));
        }
        Ok(bytes)
    }

    fn read_channels(&mut self, records: &[u8], summary: &mut Summary) -> Result<()> {
        let mut at = 0;
        while at < records.len() {
            let (op, body) = split(records, at)?;
            at = body.end;
            let body = records.get(body).unwrap_or_default();
            match op {
                op::SCHEMA => self.add_schema(body)?,
                op::CHANNEL => self.add_channel(summary, body)?,
                _ => {}
            }
        }
        Ok(())
    }

    fn load(&self, bytes: Bytes, filter: impl Fn(usize, i64) -> bool) -> Result<Loaded> {
        let mut entries = Vec::new();
        let mut at = 0;
        while at < bytes.len() {
            let (op, body) = split(&bytes, at)?;
            at = body.end;
            if op != op::MESSAGE {
                continue;
            }
            let mut fields = Fields(bytes.get(body.clone()).unwrap_or_default());
            let channel = self.index(fields.u16()?)?;
            fields.u32()?;
            let log_time_ns = time_ns(fields.u64()?)?;
            let publish_time_ns = i64::try_from(fields.u64()?).ok();
            if filter(channel, log_time_ns) {
                let (channel, start, end) = (channel as u32, body.start + MESSAGE_HEADER, body.end);
                entries.push(Entry { log_time_ns, publish_time_ns, channel, start, end });
            }
        }
        Ok(Loaded { bytes, entries })
    }
}
