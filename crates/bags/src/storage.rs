//! What every format gives its reader and takes from its writer.

use opendr_engine::Result;

use crate::channel::Channel;
use crate::recorded::Stream;
use crate::selection::Wanted;

/// One opened recording, or one file of it.
pub(crate) trait Storage: Send + Sync {
    fn summary(&self) -> &Summary;
    fn messages(&self, wanted: Wanted) -> Result<Stream>;
}

/// What is known of a recording without reading its messages.
#[derive(Debug, Clone, Default)]
pub(crate) struct Summary {
    pub channels: Vec<Channel>,
    /// Messages per channel.
    pub counts: Vec<u64>,
    /// The times of the first and last message.
    pub span: Option<(i64, i64)>,
    pub is_complete: bool,
}

impl Summary {
    pub fn add(&mut self, channel: Channel) -> usize {
        self.channels.push(channel);
        self.counts.push(0);
        self.channels.len() - 1
    }

    /// Widens the span.
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

/// One recording being written. Channels come numbered from 0, messages only of channels that came.
pub(crate) trait StorageWriter: Send {
    fn add_channel(&mut self, channel: &Channel) -> Result<()>;
    fn write(&mut self, channel: usize, log_time_ns: i64, publish_time_ns: i64, bytes: &[u8]) -> Result<()>;
    /// Hands to the operating system what is still held back.
    fn flush(&mut self) -> Result<()>;
    fn finish(&mut self) -> Result<()>;
}
