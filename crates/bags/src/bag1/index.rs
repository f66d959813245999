//! The index of a bag: read from its end, or rebuilt by scanning the file if it is missing.

use std::collections::HashSet;

use opendr_engine::{Error, Result};

use super::connection::Connections;
use super::record::{Header, Place};
use super::{MAGIC, op};
use crate::chunked::{self, Chunked, Extent, MAX_LOOSE_BYTES, Part};
use crate::fields::Fields;
use crate::source::{Source, Window};
use crate::storage::Storage;

/// Opens a bag.
pub(crate) fn open(source: Source) -> Result<impl Storage + use<>> {
    let index = Index::read(&source)?;
    Ok(Chunked::new(source, index))
}

type Index = chunked::Index<Connections>;

impl Index {
    fn read(source: &Source) -> Result<Self> {
        let place = Place::read(&mut Window::new(source), MAGIC.len() as u64)?;
        let header = Header::parse(&place.header)?;
        if header.op != op::BAG {
            return Err(Error::format("the bag does not start with its header"));
        }
        if header.encryptor.is_some_and(|name| !name.is_empty()) {
            return Err(Error::unsupported("the bag is encrypted: decrypt it with `rosbag decrypt` first"));
        }
        // Without a valid index, the chunks are still there to scan.
        Self::from_end(source, &header).or_else(|_| Ok(Self::from_scan(source, place.end())))
    }

    fn from_end(source: &Source, header: &Header) -> Result<Self> {
        let mut at = header.index_pos.filter(|position| *position > 0).unwrap_or(u64::MAX);
        let mut index = Self::default();
        let mut window = Window::new(source);
        let mut seen = HashSet::new();
        while at < source.len() {
            let place = Place::read(&mut window, at)?;
            let data = window.read(place.data, place.data_len)?;
            let header = Header::parse(&place.header)?;
            match header.op {
                op::CONNECTION => index.layout.add(&mut index.summary, &header, &data)?,
                op::CHUNK_INFO => {
                    if !seen.insert(header.chunk_pos) {
                        return Err(Error::format("the index lists a chunk twice"));
                    }
                    index.add_info(&header, &data)?;
                }
                _ => return Err(Error::format(format!("a record of type {} in the index", header.op))),
            }
            at = place.end();
        }
        let expected = (header.connection_count, header.chunk_count);
        let found = (Some(index.layout.len() as u32), Some(index.parts.len() as u32));
        if at != source.len() || expected != found {
            return Err(Error::format("the index is incomplete"));
        }
        index.summary.is_complete = true;
        Ok(index)
    }

    fn add_info(&mut self, header: &Header, data: &[u8]) -> Result<()> {
        let missing = || Error::format("the index entry of a chunk lacks fields");
        let offset = header.chunk_pos.ok_or_else(missing)?;
        let (start, end) = header.start_ns.zip(header.end_ns).ok_or_else(missing)?;
        if header.count.ok_or_else(missing)? as usize != data.len() / 8 {
            return Err(missing());
        }
        let mut channels = Vec::new();
        let mut fields = Fields(data);
        while !fields.is_empty() {
            let channel = self.layout.channel(Some(fields.u32()?))?;
            self.summary.count(channel, u64::from(fields.u32()?));
            channels.push(channel);
        }
        if !channels.is_empty() {
            self.summary.cover(start, end);
        }
        self.parts.push(Part { extent: Extent::Chunk { offset }, span: (start, end), channels });
        Ok(())
    }

    /// Scans the file, record after record, up to the first incomplete one.
    fn from_scan(source: &Source, mut at: u64) -> Self {
        let mut index = Self::default();
        let mut window = Window::new(source);
        let mut loose = None;
        while let Ok(place) = Place::read(&mut window, at) {
            let Ok(header) = Header::parse(&place.header) else { break };
            if place.end() > source.len() {
                if header.op == op::CHUNK && header.compression == Some(b"none") {
                    // The messages before the cut of a truncated chunk are complete.
                    index.add_loose(source, loose.take());
                    at = place.data;
                    continue;
                }
                break;
            }
            match header.op {
                op::CHUNK => {
                    index.add_loose(source, loose.take());
                    index.add(source, Extent::Chunk { offset: at });
                }
                op::MESSAGE | op::CONNECTION => {
                    let (offset, _) = loose.unwrap_or((at, 0));
                    loose = Some((offset, place.end() - offset));
                    if place.end() - offset > MAX_LOOSE_BYTES {
                        index.add_loose(source, loose.take());
                    }
                }
                op::INDEX | op::CHUNK_INFO => index.add_loose(source, loose.take()),
                _ => break,
            }
            at = place.end();
        }
        index.add_loose(source, loose);
        index
    }
}
