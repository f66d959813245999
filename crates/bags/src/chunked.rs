//! Files made of chunks: the common part of rosbag 1 and MCAP.

use std::sync::Arc;

use bytes::Bytes;
use opendr_engine::{Result, ResultExt};

use crate::in_order::{Chunks, InOrder, Loaded};
use crate::recorded::Stream;
use crate::selection::Filter;
use crate::source::Source;
use crate::storage::{Storage, Summary};

/// Location of messages in the file.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Extent {
    /// The record of a chunk.
    Chunk { offset: u64 },
    /// Records outside of chunks.
    Loose { offset: u64, len: u64 },
}

/// An extent with its times and channels.
pub(crate) struct Part {
    pub extent: Extent,
    pub span: (i64, i64),
    /// Channels of the messages; empty if the file does not state them.
    pub channels: Vec<usize>,
}

/// Decoding of channels and chunks of a format, with its map from channel numbers to indices.
pub(crate) trait Layout: Default + Send + Sync + 'static {
    /// Returns the records of the chunk at `offset`.
    fn chunk(source: &Source, offset: u64) -> Result<Bytes>;
    /// Adds the channels among `records` to the summary.
    fn read_channels(&mut self, records: &[u8], summary: &mut Summary) -> Result<()>;
    /// Returns the messages among records that `filter` accepts by channel and time.
    fn load(&self, records: Bytes, filter: impl Fn(usize, i64) -> bool) -> Result<Loaded>;
}

/// The content of a file without its messages.
#[derive(Default)]
pub(crate) struct Index<L> {
    pub summary: Summary,
    pub layout: L,
    pub parts: Vec<Part>,
}

impl<L: Layout> Index<L> {
    /// Adds an extent that is in no index, by reading it. A damaged extent is skipped, since others may be intact.
    pub fn add(&mut self, source: &Source, extent: Extent) {
        self.try_add(source, extent).ok();
    }

    /// Adds records outside of chunks, if there are any.
    pub fn add_loose(&mut self, source: &Source, loose: Option<(u64, u64)>) {
        if let Some((offset, len)) = loose {
            self.add(source, Extent::Loose { offset, len });
        }
    }

    fn try_add(&mut self, source: &Source, extent: Extent) -> Result<()> {
        let records = read::<L>(source, extent)?;
        self.layout.read_channels(&records, &mut self.summary)?;
        let loaded = self.layout.load(records, |_, _| true)?;
        let times = || loaded.entries.iter().map(|entry| entry.log_time_ns);
        let (Some(start), Some(end)) = (times().min(), times().max()) else { return Ok(()) };
        let mut channels: Vec<_> = loaded.entries.iter().map(|entry| entry.channel as usize).collect();
        channels.iter().for_each(|channel| self.summary.count(*channel, 1));
        channels.sort_unstable();
        channels.dedup();
        self.summary.cover(start, end);
        self.parts.push(Part { extent, span: (start, end), channels });
        Ok(())
    }
}

/// Most bytes of consecutive records outside of chunks that form one extent.
pub(crate) const MAX_LOOSE_BYTES: u64 = 1 << 20;

fn read<L: Layout>(source: &Source, extent: Extent) -> Result<Bytes> {
    match extent {
        Extent::Chunk { offset } => L::chunk(source, offset),
        Extent::Loose { offset, len } => source.read(offset, len),
    }
}

/// An opened file.
pub(crate) struct Chunked<L>(Arc<Opened<L>>);

struct Opened<L> {
    source: Source,
    index: Index<L>,
}

impl<L: Layout> Chunked<L> {
    pub fn new(source: Source, index: Index<L>) -> Self {
        Self(Arc::new(Opened { source, index }))
    }
}

impl<L: Layout> Storage for Chunked<L> {
    fn summary(&self) -> &Summary {
        &self.0.index.summary
    }

    fn messages(&self, filter: Filter) -> Result<Stream> {
        Ok(Box::new(InOrder::new(self.0.clone(), filter)))
    }
}

impl<L: Layout> Chunks for Opened<L> {
    fn count(&self) -> usize {
        self.index.parts.len()
    }

    fn span(&self, chunk: usize) -> (i64, i64) {
        self.index.parts.get(chunk).map_or((i64::MAX, i64::MIN), |part| part.span)
    }

    fn may_hold(&self, chunk: usize, filter: &Filter) -> bool {
        let channels = self.index.parts.get(chunk).map(|part| &part.channels[..]).unwrap_or_default();
        channels.is_empty() || channels.iter().any(|channel| filter.channel(*channel))
    }

    fn load(&self, chunk: usize, filter: &Filter) -> Result<Loaded> {
        let Some(part) = self.index.parts.get(chunk) else { return Ok(Loaded::default()) };
        let takes = |channel, time: i64| filter.channel(channel) && filter.times.contains(&time);
        let load = || self.index.layout.load(read::<L>(&self.source, part.extent)?, takes);
        load().context(|| format!("reading chunk {chunk} of the recording"))
    }
}
