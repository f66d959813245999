//! rosbag 1, format 2.0: records of a header with named fields and data, messages in chunks, an index at the end.
//! Source: the ROS wiki, "Bags/Format/2.0".

mod chunk;
mod connection;
mod index;
mod record;
mod writer;

pub(crate) use index::open;
pub(crate) use writer::Bag1Writer;

/// First bytes of a file.
pub(crate) const MAGIC: &[u8] = b"#ROSBAG V2.0\n";

/// Types of records.
mod op {
    pub const MESSAGE: u8 = 2;
    pub const BAG: u8 = 3;
    pub const INDEX: u8 = 4;
    pub const CHUNK: u8 = 5;
    pub const CHUNK_INFO: u8 = 6;
    pub const CONNECTION: u8 = 7;
}

/// Size of the bag's header with its padding and without the two lengths, in bytes. The size is fixed, so that the
/// header can be rewritten at the end; `rosbag reindex` relies on it.
const BAG_HEADER: usize = 4096;
