//! Messages of many chunks in order of their log time, with as few chunks in memory as possible.

use std::cmp::{Ordering, Reverse};
use std::collections::binary_heap::{BinaryHeap, PeekMut};
use std::sync::Arc;

use bytes::Bytes;
use opendr_engine::{Error, Result};

use crate::recorded::RecordedMessage;
use crate::selection::Filter;

/// Location of a message in the bytes of its chunk.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry {
    pub log_time_ns: i64,
    pub publish_time_ns: Option<i64>,
    pub channel: u32,
    pub start: usize,
    pub end: usize,
}

/// A chunk in memory with its selected messages.
#[derive(Default)]
pub(crate) struct Loaded {
    pub bytes: Bytes,
    pub entries: Vec<Entry>,
}

/// A file made of chunks.
pub(crate) trait Chunks: Send + Sync {
    fn count(&self) -> usize;
    /// Returns the times of the first and last message, as stated by the index.
    fn span(&self, chunk: usize) -> (i64, i64);
    /// Returns false only if no message of the chunk is selected.
    fn may_hold(&self, chunk: usize, filter: &Filter) -> bool;
    fn load(&self, chunk: usize, filter: &Filter) -> Result<Loaded>;
}

/// Most bytes of chunks that overlap in time and are in memory together.
const MAX_OPEN_BYTES: usize = 1 << 30;

/// Iterator over the selected messages of `chunks`.
pub(crate) struct InOrder<C> {
    filter: Filter,
    /// Chunks to load, the next one last.
    upcoming: Vec<(i64, usize)>,
    open: BinaryHeap<Reverse<Open>>,
    open_bytes: usize,
    chunks: Arc<C>,
}

impl<C: Chunks> InOrder<C> {
    pub fn new(chunks: Arc<C>, filter: Filter) -> Self {
        let is_needed = |chunk: &usize| {
            let (start, end) = chunks.span(*chunk);
            filter.span(start, end) && chunks.may_hold(*chunk, &filter)
        };
        let mut upcoming: Vec<_> =
            (0..chunks.count()).filter(is_needed).map(|chunk| (chunks.span(chunk).0, chunk)).collect();
        if !filter.in_file_order {
            upcoming.sort_unstable();
        }
        upcoming.reverse();
        Self { filter, upcoming, open: BinaryHeap::new(), open_bytes: 0, chunks }
    }

    /// Loads every chunk that may contain the next message.
    fn load(&mut self) -> Result<()> {
        while let Some(&(start, chunk)) = self.upcoming.last() {
            match self.open.peek() {
                Some(_) if self.filter.in_file_order => break,
                Some(Reverse(open)) if open.time() < start => break,
                _ => {}
            }
            self.upcoming.pop();
            let mut loaded = self.chunks.load(chunk, &self.filter)?;
            if loaded.entries.is_empty() {
                continue;
            }
            if !self.filter.in_file_order {
                // The sort is stable: messages of the same time keep the order of the file.
                loaded.entries.sort_by_key(|entry| entry.log_time_ns);
            }
            self.open_bytes = self.open_bytes.saturating_add(loaded.bytes.len());
            if !self.open.is_empty() && self.open_bytes > MAX_OPEN_BYTES {
                return Err(Error::unsupported(format!(
                    "{} chunks with {} MB overlap in time: read the recording in file order, or rewrite it \
                    with its messages in order of time",
                    self.open.len() + 1,
                    self.open_bytes >> 20
                )));
            }
            self.open.push(Reverse(Open { loaded, at: 0, chunk }));
        }
        Ok(())
    }
}

impl<C: Chunks> Iterator for InOrder<C> {
    type Item = Result<RecordedMessage>;

    fn next(&mut self) -> Option<Self::Item> {
        if let Err(error) = self.load() {
            self.upcoming.clear();
            self.open.clear();
            return Some(Err(error));
        }
        let mut top = self.open.peek_mut()?;
        let Reverse(open) = &mut *top;
        let entry = open.loaded.entries.get(open.at).copied()?;
        let bytes = open.loaded.bytes.slice(entry.start..entry.end);
        open.at += 1;
        if open.at == open.loaded.entries.len() {
            let Reverse(done) = PeekMut::pop(top);
            self.open_bytes -= done.loaded.bytes.len();
        }
        Some(Ok(RecordedMessage {
            channel: entry.channel as usize,
            log_time_ns: entry.log_time_ns,
            publish_time_ns: entry.publish_time_ns,
            bytes,
        }))
    }
}

/// A chunk in memory with messages left to return.
struct Open {
    loaded: Loaded,
    at: usize,
    chunk: usize,
}

impl Open {
    fn time(&self) -> i64 {
        self.loaded.entries.get(self.at).map_or(i64::MAX, |entry| entry.log_time_ns)
    }
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        (self.time(), self.chunk).cmp(&(other.time(), other.chunk))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}
