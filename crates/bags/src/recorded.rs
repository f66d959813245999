//! Messages of a recording.

use bytes::Bytes;

/// A message as it was recorded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecordedMessage {
    /// Index into [`Bag::channels`](crate::Bag::channels).
    pub channel: usize,
    /// Time of recording, in nanoseconds since 1970 (or of the simulation's clock).
    pub log_time_ns: i64,
    /// Time of publication in nanoseconds, if the format has it (MCAP).
    pub publish_time_ns: Option<i64>,
    /// The message in the encoding of its channel. The bytes are a view that keeps the whole chunk (about 1 MB, or
    /// the largest message) in memory: copy messages that are kept for long.
    pub bytes: Bytes,
}

/// Iterator over the messages of any storage.
pub(crate) type Stream = Box<dyn Iterator<Item = opendr_engine::Result<RecordedMessage>> + Send>;
