//! One message of a recording.

use bytes::Bytes;

/// One message as it was recorded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recorded {
    /// Index into [`Bag::channels`](crate::Bag::channels).
    pub channel: usize,
    /// When it was recorded, nanoseconds since 1970 (or of the simulation's clock).
    pub log_time_ns: i64,
    /// When it was published, where the format keeps it (MCAP).
    pub publish_time_ns: Option<i64>,
    /// The message in its channel's encoding. A view into the chunk that was read: it keeps the whole chunk
    /// (about 1 MB, or the largest message) in memory, so copy what is kept for long.
    pub bytes: Bytes,
}

/// Messages one after the other, of any storage.
pub(crate) type Stream = Box<dyn Iterator<Item = opendr_engine::Result<Recorded>> + Send>;
