//! MCAP: records of a type, a length and a body; messages in chunks, a summary at the end.
//! Source: the MCAP specification, version 0.

mod channels;
mod chunk;
mod index;
mod record;
mod writer;

pub(crate) use index::open;
pub(crate) use writer::McapWriter;

/// First and last bytes of a file.
pub(crate) const MAGIC: &[u8] = b"\x89MCAP0\r\n";

/// Types of records.
mod op {
    pub const HEADER: u8 = 1;
    pub const FOOTER: u8 = 2;
    pub const SCHEMA: u8 = 3;
    pub const CHANNEL: u8 = 4;
    pub const MESSAGE: u8 = 5;
    pub const CHUNK: u8 = 6;
    pub const MESSAGE_INDEX: u8 = 7;
    pub const CHUNK_INDEX: u8 = 8;
    pub const STATISTICS: u8 = 11;
    pub const METADATA: u8 = 12;
    pub const METADATA_INDEX: u8 = 13;
    pub const SUMMARY_OFFSET: u8 = 14;
    pub const DATA_END: u8 = 15;
}

/// Bytes of a message record before the message: channel, sequence, log time, publish time.
const MESSAGE_HEADER: usize = 2 + 4 + 8 + 8;

/// Bytes of the footer record: type and length, two offsets, a checksum.
const FOOTER: u64 = 9 + 20;
