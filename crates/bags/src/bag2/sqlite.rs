//! One SQLite file of rosbag2: the tables `topics`, `messages` and, since Iron, `message_definitions`.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result, ResultExt};
use rusqlite::config::DbConfig;
use rusqlite::limits::Limit;
use rusqlite::{Connection, OpenFlags, OptionalExtension};

use super::rows::Rows;
use super::sqlite_error::sqlite_error;
use crate::channel::{Channel, Definition, Encoding, Language};
use crate::recorded::Stream;
use crate::selection::Filter;
use crate::storage::{Storage, Summary};

/// An opened file. Each reader has a connection of its own, since SQLite's connections cannot be shared.
pub(crate) struct Sqlite {
    path: PathBuf,
    /// Channel indices by id of the table `topics`.
    topics: HashMap<i64, usize>,
    is_zstd: bool,
    summary: Summary,
}

impl Sqlite {
    /// Opens the file at `path`. `is_zstd`: the bytes of each message are compressed.
    pub fn open(path: &Path, is_zstd: bool) -> Result<Self> {
        let read = || -> Result<Self> {
            let database = connect(path)?;
            let mut storage =
                Self { path: path.to_owned(), topics: HashMap::new(), is_zstd, summary: Summary::default() };
            storage.read_topics(&database).map_err(sqlite_error)?;
            storage.read_counts(&database).map_err(sqlite_error)?;
            Ok(storage)
        };
        read().context(|| format!("reading {}", path.display()))
    }

    fn read_topics(&mut self, database: &Connection) -> rusqlite::Result<()> {
        let definitions = definitions(database)?;
        let mut topics = database.prepare("SELECT * FROM topics ORDER BY id")?;
        let column = |name: &str| topics.column_index(name).ok();
        let (qos, hash) = (column("offered_qos_profiles"), column("type_description_hash"));
        let mut rows = topics.query([])?;
        while let Some(row) = rows.next()? {
            let encoding = Encoding::from_name(&row.get::<_, String>("serialization_format")?);
            let mut channel =
                Channel::new(row.get::<_, String>("name")?, row.get::<_, String>("type")?, encoding);
            let text = |column: Option<usize>| -> rusqlite::Result<Option<String>> {
                let text = column.map(|column| row.get::<_, Option<String>>(column)).transpose()?;
                Ok(text.flatten().filter(|text| !text.is_empty()))
            };
            channel.qos = text(qos)?;
            channel.type_hash = text(hash)?;
            channel.definition = definitions.get(&channel.message_type).cloned();
            let index = self.summary.add(channel);
            self.topics.insert(row.get("id")?, index);
        }
        Ok(())
    }

    fn read_counts(&mut self, database: &Connection) -> rusqlite::Result<()> {
        let mut counts = database.prepare("SELECT topic_id, COUNT(*) FROM messages GROUP BY topic_id")?;
        let mut rows = counts.query([])?;
        while let Some(row) = rows.next()? {
            if let Some(channel) = self.topics.get(&row.get(0)?) {
                self.summary.count(*channel, row.get::<_, i64>(1)?.unsigned_abs());
            }
        }
        let span = "SELECT (SELECT MIN(timestamp) FROM messages), (SELECT MAX(timestamp) FROM messages)";
        self.summary.span = database.query_row(span, [], |row| {
            let (start, end): (Option<i64>, Option<i64>) = (row.get(0)?, row.get(1)?);
            Ok(start.zip(end))
        })?;
        // Since Iron, the recorder stores its metadata in the file when it finishes.
        let metadata = "SELECT 1 FROM metadata LIMIT 1";
        self.summary.is_complete = has_table(database, "metadata")?
            && database.query_row(metadata, [], |_| Ok(())).optional()?.is_some();
        Ok(())
    }
}

impl Storage for Sqlite {
    fn summary(&self) -> &Summary {
        &self.summary
    }

    fn messages(&self, filter: Filter) -> Result<Stream> {
        let rows = || Rows::new(connect(&self.path)?, self.topics.clone(), &filter, self.is_zstd);
        Ok(Box::new(rows().context(|| format!("reading {}", self.path.display()))?))
    }
}

/// Opens an untrusted file read-only, with triggers, views and schema functions disabled.
fn connect(path: &Path) -> Result<Connection> {
    let open = || -> rusqlite::Result<Connection> {
        let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
        let database = Connection::open_with_flags(path, flags)?;
        database.set_db_config(DbConfig::SQLITE_DBCONFIG_DEFENSIVE, true)?;
        database.set_db_config(DbConfig::SQLITE_DBCONFIG_TRUSTED_SCHEMA, false)?;
        database.set_db_config(DbConfig::SQLITE_DBCONFIG_ENABLE_VIEW, false)?;
        database.set_db_config(DbConfig::SQLITE_DBCONFIG_ENABLE_TRIGGER, false)?;
        database.set_limit(Limit::SQLITE_LIMIT_LENGTH, i32::MAX)?;
        Ok(database)
    };
    let database = open().map_err(sqlite_error)?;
    for table in ["topics", "messages"] {
        if !has_table(&database, table).map_err(sqlite_error)? {
            return Err(Error::format(format!("not a recording of rosbag2: it has no table {table:?}")));
        }
    }
    Ok(database)
}

fn has_table(database: &Connection, name: &str) -> rusqlite::Result<bool> {
    let query = "SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = ?1";
    Ok(database.query_row(query, [name], |_| Ok(())).optional()?.is_some())
}

fn definitions(database: &Connection) -> rusqlite::Result<HashMap<String, Definition>> {
    if !has_table(database, "message_definitions")? {
        return Ok(HashMap::new());
    }
    let query = "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions \
                 WHERE encoding IN ('ros2msg', 'ros2idl')";
    let mut definitions = database.prepare(query)?;
    let rows = definitions.query_map([], |row| {
        let language = if row.get::<_, String>(1)? == "ros2idl" { Language::Idl } else { Language::Msg };
        Ok((row.get(0)?, Definition { language, text: row.get(2)? }))
    })?;
    rows.collect()
}
