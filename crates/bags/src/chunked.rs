//! Files made of chunks: what rosbag 1 and MCAP have in common.

use std::sync::Arc;

use bytes::Bytes;
use opendr_engine::{Result, ResultExt};

use crate::in_order::{Chunks, InOrder, Loaded};
use crate::recorded::Stream;
use crate::selection::Wanted;
use crate::source::Source;
use crate::storage::{Storage, Summary};

/// Where messages are.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Stretch {
    /// A chunk's record.
    Chunk { offset: u64 },
    /// Records outside of chunks.
    Loose { offset: u64, len: u64 },
}

/// A stretch with what is known of it.
pub(crate) struct Part {
    pub stretch: Stretch,
    pub span: (i64, i64),
    /// The channels of its messages; none where the file does not tell.
    pub channels: Vec<usize>,
}

/// How a format writes channels and chunks; holds the format's numbers of channels.
pub(crate) trait Layout: Default + Send + Sync + 'static {
    /// The records of the chunk at `offset`.
    fn chunk(source: &Source, offset: u64) -> Result<Bytes>;
    /// Takes in the channels among records.
    fn learn(&mut self, records: &[u8], summary: &mut Summary) -> Result<()>;
    /// The messages among records that `wanted` takes by channel and time.
    fn load(&self, records: Bytes, wanted: impl Fn(usize, i64) -> bool) -> Result<Loaded>;
}

/// Everything of a file but its messages.
#[derive(Default)]
pub(crate) struct Index<L> {
    pub summary: Summary,
    pub layout: L,
    pub parts: Vec<Part>,
}

impl<L: Layout> Index<L> {
    /// Takes in a stretch that no index tells of, by reading it. One that is damaged is left out: others may not be.
    pub fn add(&mut self, source: &Source, stretch: Stretch) {
        self.try_add(source, stretch).ok();
    }

    /// Likewise records outside of chunks, where there are some.
    pub fn add_loose(&mut self, source: &Source, loose: Option<(u64, u64)>) {
        if let Some((offset, len)) = loose {
            self.add(source, Stretch::Loose { offset, len });
        }
    }

    fn try_add(&mut self, source: &Source, stretch: Stretch) -> Result<()> {
        let records = read::<L>(source, stretch)?;
        self.layout.learn(&records, &mut self.summary)?;
        let loaded = self.layout.load(records, |_, _| true)?;
        let times = || loaded.entries.iter().map(|entry| entry.log_time_ns);
        let (Some(start), Some(end)) = (times().min(), times().max()) else { return Ok(()) };
        let mut channels: Vec<_> = loaded.entries.iter().map(|entry| entry.channel as usize).collect();
        channels.iter().for_each(|channel| self.summary.count(*channel, 1));
        channels.sort_unstable();
        channels.dedup();
        self.summary.cover(start, end);
        self.parts.push(Part { stretch, span: (start, end), channels });
        Ok(())
    }
}

/// Loose records are taken together up to this many bytes.
pub(crate) const TOGETHER: u64 = 1 << 20;

fn read<L: Layout>(source: &Source, stretch: Stretch) -> Result<Bytes> {
    match stretch {
        Stretch::Chunk { offset } => L::chunk(source, offset),
        Stretch::Loose { offset, len } => source.read(offset, len),
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

    fn messages(&self, wanted: Wanted) -> Result<Stream> {
        Ok(Box::new(InOrder::new(self.0.clone(), wanted)))
    }
}

impl<L: Layout> Chunks for Opened<L> {
    fn count(&self) -> usize {
        self.index.parts.len()
    }

    fn span(&self, chunk: usize) -> (i64, i64) {
        self.index.parts.get(chunk).map_or((i64::MAX, i64::MIN), |part| part.span)
    }

    fn may_hold(&self, chunk: usize, wanted: &Wanted) -> bool {
        let channels = self.index.parts.get(chunk).map(|part| &part.channels[..]).unwrap_or_default();
        channels.is_empty() || channels.iter().any(|channel| wanted.channel(*channel))
    }

    fn load(&self, chunk: usize, wanted: &Wanted) -> Result<Loaded> {
        let Some(part) = self.index.parts.get(chunk) else { return Ok(Loaded::default()) };
        let takes = |channel, time: i64| wanted.channel(channel) && wanted.times.contains(&time);
        let load = || self.index.layout.load(read::<L>(&self.source, part.stretch)?, takes);
        load().context(|| format!("reading chunk {chunk} of the recording"))
    }
}
