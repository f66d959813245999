//! Messages of many chunks in order of their log time, with as few chunks in memory as their times allow.

use std::cmp::{Ordering, Reverse};
use std::collections::binary_heap::{BinaryHeap, PeekMut};
use std::sync::Arc;

use bytes::Bytes;
use opendr_engine::{Error, Result};

use crate::recorded::Recorded;
use crate::selection::Wanted;

/// Where a message is in the bytes of its chunk.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry {
    pub log_time_ns: i64,
    pub publish_time_ns: Option<i64>,
    pub channel: u32,
    pub start: usize,
    pub end: usize,
}

/// A chunk in memory with those of its messages that are wanted.
#[derive(Default)]
pub(crate) struct Loaded {
    pub bytes: Bytes,
    pub entries: Vec<Entry>,
}

/// A file made of chunks.
pub(crate) trait Chunks: Send + Sync {
    fn count(&self) -> usize;
    /// The times of the first and last message, as the index tells them.
    fn span(&self, chunk: usize) -> (i64, i64);
    /// False only when nothing in it can be wanted.
    fn may_hold(&self, chunk: usize, wanted: &Wanted) -> bool;
    fn load(&self, chunk: usize, wanted: &Wanted) -> Result<Loaded>;
}

/// Chunks that overlap in time are in memory together, up to this many bytes.
const TOGETHER: usize = 1 << 30;

/// The wanted messages of `chunks`.
pub(crate) struct InOrder<C> {
    wanted: Wanted,
    /// Chunks still to be loaded, the next one last.
    upcoming: Vec<(i64, usize)>,
    open: BinaryHeap<Reverse<Open>>,
    open_bytes: usize,
    chunks: Arc<C>,
}

impl<C: Chunks> InOrder<C> {
    pub fn new(chunks: Arc<C>, wanted: Wanted) -> Self {
        let held = |chunk: &usize| {
            let (start, end) = chunks.span(*chunk);
            wanted.span(start, end) && chunks.may_hold(*chunk, &wanted)
        };
        let mut upcoming: Vec<_> =
            (0..chunks.count()).filter(held).map(|chunk| (chunks.span(chunk).0, chunk)).collect();
        if !wanted.in_file_order {
            upcoming.sort_unstable();
        }
        upcoming.reverse();
        Self { wanted, upcoming, open: BinaryHeap::new(), open_bytes: 0, chunks }
    }

    /// Loads every chunk that can hold the next message.
    fn load(&mut self) -> Result<()> {
        while let Some(&(start, chunk)) = self.upcoming.last() {
            match self.open.peek() {
                Some(_) if self.wanted.in_file_order => break,
                Some(Reverse(open)) if open.time() < start => break,
                _ => {}
            }
            self.upcoming.pop();
            let mut loaded = self.chunks.load(chunk, &self.wanted)?;
            if loaded.entries.is_empty() {
                continue;
            }
            if !self.wanted.in_file_order {
                // Stable: messages of the same time stay in the order of the file.
                loaded.entries.sort_by_key(|entry| entry.log_time_ns);
            }
            self.open_bytes = self.open_bytes.saturating_add(loaded.bytes.len());
            if !self.open.is_empty() && self.open_bytes > TOGETHER {
                return Err(Error::unsupported(format!(
                    "{} chunks with {} MB overlap in time: read this recording in file order, or rewrite it \
                     with its messages in order of their times",
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
    type Item = Result<Recorded>;

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
        Some(Ok(Recorded {
            channel: entry.channel as usize,
            log_time_ns: entry.log_time_ns,
            publish_time_ns: entry.publish_time_ns,
            bytes,
        }))
    }
}

/// A chunk in memory of which messages are still to come.
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
