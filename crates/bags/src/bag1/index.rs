//! What a bag's end tells of its chunks, or a walk through the file where the end is missing.

use std::collections::HashSet;

use opendr_engine::{Error, Result};

use super::connection::Connections;
use super::record::{Header, Place};
use super::{MAGIC, op};
use crate::chunked::{self, Chunked, Part, Stretch, TOGETHER};
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
        // An index that is not whole is as good as none: the chunks are all still there.
        Self::from_end(source, &header).or_else(|_| Ok(Self::from_walk(source, place.end())))
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
                        return Err(Error::format("the index tells of a chunk twice"));
                    }
                    index.add_info(&header, &data)?;
                }
                _ => return Err(Error::format(format!("a record of kind {} in the index", header.op))),
            }
            at = place.end();
        }
        let told = (header.connection_count, header.chunk_count);
        let found = (Some(index.layout.len() as u32), Some(index.parts.len() as u32));
        if at != source.len() || told != found {
            return Err(Error::format("the index is not whole"));
        }
        index.summary.is_complete = true;
        Ok(index)
    }

    fn add_info(&mut self, header: &Header, data: &[u8]) -> Result<()> {
        let missing = || Error::format("a chunk's entry in the index lacks fields");
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
        self.parts.push(Part { stretch: Stretch::Chunk { offset }, span: (start, end), channels });
        Ok(())
    }

    /// Reads record after record up to the first that is not whole.
    fn from_walk(source: &Source, mut at: u64) -> Self {
        let mut index = Self::default();
        let mut window = Window::new(source);
        let mut loose = None;
        while let Ok(place) = Place::read(&mut window, at) {
            let Ok(header) = Header::parse(&place.header) else { break };
            if place.end() > source.len() {
                if header.op == op::CHUNK && header.compression == Some(b"none") {
                    // Of a chunk that was cut, the messages before the cut are whole.
                    index.add_loose(source, loose.take());
                    at = place.data;
                    continue;
                }
                break;
            }
            match header.op {
                op::CHUNK => {
                    index.add_loose(source, loose.take());
                    index.add(source, Stretch::Chunk { offset: at });
                }
                op::MESSAGE | op::CONNECTION => {
                    let (offset, _) = loose.unwrap_or((at, 0));
                    loose = Some((offset, place.end() - offset));
                    if place.end() - offset > TOGETHER {
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
