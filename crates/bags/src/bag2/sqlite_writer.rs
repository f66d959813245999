//! Writer of the SQLite file of rosbag2, schema version 4.

use std::collections::HashSet;
use std::path::Path;

use opendr_engine::{Error, Result};
use rusqlite::Connection;

use super::metadata::VERSION;
use super::sqlite_error::sqlite_error;
use crate::channel::{Channel, Language};

const SCHEMA: &str = "
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
  serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL, type_description_hash TEXT NOT NULL);
CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding TEXT NOT NULL,
  encoded_message_definition TEXT NOT NULL, type_description_hash TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,
  data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
INSERT INTO schema(schema_version, ros_distro) VALUES (4, 'opendr');
";

/// A file being written. Flushed messages stay readable after a crash.
pub(super) struct SqliteWriter {
    database: Connection,
    types: HashSet<String>,
    topics: i64,
    /// Bytes in the open transaction; 0 if none is open.
    open_bytes: usize,
    chunk_bytes: usize,
}

impl SqliteWriter {
    pub fn new(path: &Path, chunk_bytes: usize) -> Result<Self> {
        let database = Connection::open(path).map_err(sqlite_error)?;
        let prepare = || {
            // With a write-ahead log, the file needs no repair after a crash.
            database.pragma_update_and_check(None, "journal_mode", "wal", |_| Ok(()))?;
            database.pragma_update(None, "synchronous", "normal")?;
            database.execute_batch(SCHEMA)
        };
        prepare().map_err(sqlite_error)?;
        Ok(Self { database, types: HashSet::new(), topics: 0, open_bytes: 0, chunk_bytes })
    }

    pub fn add_channel(&mut self, channel: &Channel) -> Result<()> {
        let (qos, hash) = (channel.qos.as_deref().unwrap_or(""), channel.type_hash.as_deref().unwrap_or(""));
        self.topics += 1;
        let insert = "INSERT INTO topics VALUES(?1, ?2, ?3, 'cdr', ?4, ?5)";
        let row = (self.topics, &channel.topic, &channel.message_type, qos, hash);
        self.database.execute(insert, row).map_err(sqlite_error)?;
        if let Some(definition) = &channel.definition
            && self.types.insert(channel.message_type.clone())
        {
            let language = if definition.language == Language::Idl { "ros2idl" } else { "ros2msg" };
            let insert = "INSERT INTO message_definitions \
                          (topic_type, encoding, encoded_message_definition, type_description_hash) \
                          VALUES(?1, ?2, ?3, ?4)";
            let row = (&channel.message_type, language, &definition.text, hash);
            self.database.execute(insert, row).map_err(sqlite_error)?;
        }
        Ok(())
    }

    pub fn write(&mut self, channel: usize, log_time_ns: i64, bytes: &[u8]) -> Result<()> {
        let topic = channel as i64 + 1;
        if topic > self.topics {
            return Err(Error::internal(format!("channel {channel} was not added")));
        }
        let write = || {
            if self.open_bytes == 0 {
                self.database.execute_batch("BEGIN")?;
            }
            let insert = "INSERT INTO messages (topic_id, timestamp, data) VALUES(?1, ?2, ?3)";
            self.database.prepare_cached(insert)?.execute((topic, log_time_ns, bytes))
        };
        write().map_err(sqlite_error)?;
        self.open_bytes += bytes.len() + 32;
        if self.open_bytes >= self.chunk_bytes { self.flush() } else { Ok(()) }
    }

    pub fn flush(&mut self) -> Result<()> {
        if self.open_bytes > 0 {
            self.database.execute_batch("COMMIT").map_err(sqlite_error)?;
            self.open_bytes = 0;
        }
        Ok(())
    }

    pub fn finish(&mut self, metadata: &str) -> Result<()> {
        self.flush()?;
        let insert = "INSERT INTO metadata(metadata_version, metadata) VALUES(?1, ?2)";
        self.database.execute(insert, (VERSION, metadata)).map_err(sqlite_error)?;
        // Moves the content of the log into the file, since other readers read the file alone.
        self.database
            .pragma_update_and_check(None, "journal_mode", "delete", |_| Ok(()))
            .map_err(sqlite_error)
    }
}
