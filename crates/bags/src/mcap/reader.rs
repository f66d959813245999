//! Messages of an MCAP file.

use std::sync::Arc;

use opendr_engine::{Result, ResultExt};

use super::chunk;
use super::index::Index;
use crate::in_order::{Chunks, InOrder, Loaded};
use crate::recorded::Stream;
use crate::selection::Wanted;
use crate::source::Source;
use crate::storage::{Storage, Summary};

/// An opened file.
pub(crate) struct Mcap(Arc<Parts>);

struct Parts {
    source: Source,
    index: Index,
}

impl Mcap {
    pub fn open(source: Source) -> Result<Self> {
        let index = Index::read(&source)?;
        Ok(Self(Arc::new(Parts { source, index })))
    }
}

impl Storage for Mcap {
    fn summary(&self) -> &Summary {
        &self.0.index.summary
    }

    fn messages(&self, wanted: Wanted) -> Result<Stream> {
        Ok(Box::new(InOrder::new(self.0.clone(), wanted)))
    }
}

impl Chunks for Parts {
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
        let Some(part) = self.index.parts.get(chunk) else {
            return Ok(Loaded { bytes: Default::default(), entries: Vec::new() });
        };
        let takes = |channel, time: i64| wanted.channel(channel) && wanted.times.contains(&time);
        let load = || chunk::load(part.stretch.read(&self.source)?, &self.index.channels, takes);
        load().context(|| format!("reading chunk {chunk} of the MCAP file"))
    }
}
