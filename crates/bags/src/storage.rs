//! The interface between recordings and their formats.

use opendr_engine::Result;

use crate::channel::Channel;
use crate::recorded::Stream;
use crate::selection::Filter;

/// An opened recording, or a file of it.
pub(crate) trait Storage: Send + Sync {
    fn summary(&self) -> &Summary;
    fn messages(&self, filter: Filter) -> Result<Stream>;
}

/// The properties of a recording that are available without reading its messages.
#[derive(Debug, Clone, Default)]
pub(crate) struct Summary {
    pub channels: Vec<Channel>,
    /// Messages per channel.
    pub counts: Vec<u64>,
    /// Times of the first and last message.
    pub span: Option<(i64, i64)>,
    pub is_complete: bool,
}

impl Summary {
    pub fn add(&mut self, channel: Channel) -> usize {
        self.channels.push(channel);
        self.counts.push(0);
        self.channels.len() - 1
    }

    /// Extends the time span.
    pub fn cover(&mut self, start: i64, end: i64) {
        let (first, last) = self.span.unwrap_or((start, end));
        self.span = Some((first.min(start), last.max(end)));
    }

    pub fn count(&mut self, channel: usize, messages: u64) {
        if let Some(count) = self.counts.get_mut(channel) {
            *count = count.saturating_add(messages);
        }
    }
}

/// A recording being written. Channels are numbered from 0 in the order they are added.
pub(crate) trait StorageWriter: Send {
    fn add_channel(&mut self, channel: &Channel) -> Result<()>;
    fn write(&mut self, channel: usize, log_time_ns: i64, publish_time_ns: i64, bytes: &[u8]) -> Result<()>;
    /// Passes buffered messages to the operating system.
    fn flush(&mut self) -> Result<()>;
    fn finish(&mut self) -> Result<()>;
}
