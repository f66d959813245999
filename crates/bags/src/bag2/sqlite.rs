//! One SQLite file of rosbag2: the tables `topics`, `messages` and, since Iron, `message_definitions`.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result, ResultExt};
use rusqlite::config::DbConfig;
use rusqlite::limits::Limit;
use rusqlite::{Connection, OpenFlags, OptionalExtension};

use super::rows::Rows;
use crate::channel::{Channel, Definition, Encoding, Language};
use crate::recorded::Stream;
use crate::selection::Wanted;
use crate::storage::{Storage, Summary};

/// An opened file. Connections are made for each reading, since SQLite's are not shared.
pub(crate) struct Sqlite {
    path: PathBuf,
    /// The rows of `topics` as indices of channels.
    topics: HashMap<i64, usize>,
    is_zstd: bool,
    summary: Summary,
}

impl Sqlite {
    /// `is_zstd`: every message's bytes are compressed.
    pub fn open(path: &Path, is_zstd: bool) -> Result<Self> {
        let read = || -> Result<Self> {
            let database = connect(path)?;
            let mut storage =
                Self { path: path.to_owned(), topics: HashMap::new(), is_zstd, summary: Summary::default() };
            storage.read_topics(&database).map_err(refused)?;
            storage.read_counts(&database).map_err(refused)?;
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
        // Since Iron the recorder leaves its metadata in the file when it ends.
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

    fn messages(&self, wanted: Wanted) -> Result<Stream> {
        let rows = || Rows::new(connect(&self.path)?, self.topics.clone(), &wanted, self.is_zstd);
        Ok(Box::new(rows().context(|| format!("reading {}", self.path.display()))?))
    }
}

/// Opens a file from outside: nothing in it may run, nothing is written to it.
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
    let database = open().map_err(refused)?;
    for table in ["topics", "messages"] {
        if !has_table(&database, table).map_err(refused)? {
            return Err(Error::format(format!("no recording of rosbag2: there is no table {table:?}")));
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

/// SQLite's refusals: a file that is no database or damaged is one of format, the rest is the system's.
pub(super) fn refused(error: rusqlite::Error) -> Error {
    use rusqlite::ErrorCode::{
        CannotOpen, DatabaseBusy, DatabaseLocked, DiskFull, ReadOnly, SystemIoFailure,
    };
    match error.sqlite_error_code() {
        Some(ReadOnly) => Error::io(
            "the recording was cut off while it was written: open it once with `sqlite3 FILE .tables` to repair it",
        ),
        Some(CannotOpen | DatabaseBusy | DatabaseLocked | DiskFull | SystemIoFailure) => {
            Error::io("SQLite refused").with_source(error)
        }
        _ => Error::format("SQLite cannot read the recording").with_source(error),
    }
}
