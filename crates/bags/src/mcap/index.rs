//! The index of an MCAP file: read from its summary, or rebuilt by scanning the file if there is none.

use std::collections::HashSet;

use opendr_engine::{Error, Result};

use super::channels::Channels;
use super::record::{Place, time_ns};
use super::{FOOTER, MAGIC, op};
use crate::chunked::{self, Chunked, Extent, MAX_LOOSE_BYTES, Part};
use crate::fields::Fields;
use crate::source::{Source, Window};
use crate::storage::Storage;

/// Opens an MCAP file.
pub(crate) fn open(source: Source) -> Result<impl Storage + use<>> {
    let index = Index::read(&source)?;
    Ok(Chunked::new(source, index))
}

type Index = chunked::Index<Channels>;

impl Index {
    fn read(source: &Source) -> Result<Self> {
        let start = MAGIC.len() as u64;
        let header = Place::read(&mut Window::new(source), start)?;
        if header.op != op::HEADER {
            return Err(Error::format("the MCAP file does not start with its header"));
        }
        let footer = footer(source).ok();
        let summary = footer.and_then(|at| Self::from_summary(source, at).ok());
        Ok(summary.unwrap_or_else(|| {
            let mut index = Self::from_scan(source, header.end());
            index.summary.is_complete = footer.is_some();
            index
        }))
    }

    /// Reads the summary. An insufficient summary is an error, after which the file is scanned.
    fn from_summary(source: &Source, footer: u64) -> Result<Self> {
        let mut window = Window::new(source);
        let mut at = Fields(&window.read(footer + 9, 8)?).u64()?;
        if at == 0 || at > footer {
            return Err(Error::format("the MCAP file has no summary"));
        }
        let mut index = Self::default();
        let mut statistics = None;
        let mut infos = Vec::new();
        while at < footer {
            let place = Place::read(&mut window, at)?;
            let body = match place.op {
                op::SCHEMA | op::CHANNEL | op::CHUNK_INDEX | op::STATISTICS => place.body(&mut window)?,
                _ => Default::default(),
            };
            match place.op {
                op::SCHEMA => index.layout.add_schema(&body)?,
                op::CHANNEL => index.layout.add_channel(&mut index.summary, &body)?,
                op::CHUNK_INDEX => infos.push(body),
                op::STATISTICS => statistics = Some(body),
                _ => {}
            }
            at = place.end();
        }
        let statistics = statistics.ok_or_else(|| Error::format("the summary has no statistics"))?;
        index.add_statistics(&mut Fields(&statistics), infos.len())?;
        let mut seen = HashSet::new();
        infos.iter().try_for_each(|info| index.add_info(&mut Fields(info), &mut seen))?;
        index.summary.is_complete = true;
        Ok(index)
    }

    fn add_statistics(&mut self, fields: &mut Fields, chunks: usize) -> Result<()> {
        let messages = fields.u64()?;
        fields.u16()?;
        let channels = fields.u32()? as usize;
        fields.take(8)?;
        let stated_chunks = fields.u32()? as usize;
        // Messages outside of chunks are not indexed.
        if channels != self.layout.len() || stated_chunks != chunks || (messages > 0 && chunks == 0) {
            return Err(Error::format("the summary is incomplete"));
        }
        let (start, end) = (time_ns(fields.u64()?)?, time_ns(fields.u64()?)?);
        if messages > 0 {
            self.summary.cover(start, end);
        }
        let mut counts = Fields(fields.sized()?);
        let mut total = 0_u64;
        while !counts.is_empty() {
            let (channel, count) = (self.layout.index(counts.u16()?)?, counts.u64()?);
            self.summary.count(channel, count);
            total = total.saturating_add(count);
        }
        if total != messages {
            return Err(Error::format("the summary has no message count for some channels"));
        }
        Ok(())
    }

    fn add_info(&mut self, fields: &mut Fields, seen: &mut HashSet<u64>) -> Result<()> {
        let span = (time_ns(fields.u64()?)?, time_ns(fields.u64()?)?);
        let offset = fields.u64()?;
        if !seen.insert(offset) {
            return Err(Error::format("the summary lists a chunk twice"));
        }
        fields.u64()?;
        let mut offsets = Fields(fields.sized()?);
        let mut channels = Vec::new();
        while !offsets.is_empty() {
            channels.push(self.layout.index(offsets.u16()?)?);
            offsets.u64()?;
        }
        self.parts.push(Part { extent: Extent::Chunk { offset }, span, channels });
        Ok(())
    }

    /// Scans the file, record after record, up to the first incomplete one.
    fn from_scan(source: &Source, mut at: u64) -> Self {
        let mut index = Self::default();
        let mut window = Window::new(source);
        let mut loose = None;
        while let Ok(place) = Place::read(&mut window, at) {
            if place.end() > source.len() || place.op == 0 {
                break;
            }
            match place.op {
                op::CHUNK => {
                    index.add_loose(source, loose.take());
                    index.add(source, Extent::Chunk { offset: at });
                }
                op::SCHEMA | op::CHANNEL | op::MESSAGE => {
                    let (offset, _) = loose.unwrap_or((at, 0));
                    loose = Some((offset, place.end() - offset));
                    if place.end() - offset > MAX_LOOSE_BYTES {
                        index.add_loose(source, loose.take());
                    }
                }
                op::DATA_END | op::FOOTER => break,
                _ => index.add_loose(source, loose.take()),
            }
            at = place.end();
        }
        index.add_loose(source, loose);
        index
    }
}

/// Returns the offset of the footer of a finished file.
fn footer(source: &Source) -> Result<u64> {
    let magic = MAGIC.len() as u64;
    let missing = || Error::format("the MCAP file has no footer");
    let at = source.len().checked_sub(magic + FOOTER).ok_or_else(missing)?;
    let place = Place::read(&mut Window::new(source), at)?;
    let end = source.read(source.len() - magic, magic)?;
    let is_whole = place.op == op::FOOTER && place.len == FOOTER - 9 && end == MAGIC;
    is_whole.then_some(at).ok_or_else(missing)
}
