//! rosbag 2: a folder with `metadata.yaml` and one or more files of one storage, SQLite or MCAP.

mod compressed;
mod folder;
mod metadata;
mod rows;
mod sqlite;
mod sqlite_error;
mod sqlite_writer;
mod writer;

pub(crate) use folder::{Folder, METADATA};
pub(crate) use sqlite::Sqlite;
pub(crate) use writer::{Bag2Writer, remove};

/// First bytes of a SQLite file.
pub(crate) const SQLITE_MAGIC: &[u8] = b"SQLite format 3\0";
