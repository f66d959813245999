//! Writer of a folder of rosbag2.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result, ResultExt};

use super::METADATA;
use super::metadata::{document, to_yaml};
use super::sqlite_writer::SqliteWriter;
use crate::channel::Channel;
use crate::compression::Compression;
use crate::mcap::McapWriter;
use crate::storage::{StorageWriter, Summary};

/// A folder being written. Its metadata is written last.
pub(crate) struct Bag2Writer {
    folder: PathBuf,
    file: String,
    storage: Inner,
    summary: Summary,
}

enum Inner {
    Sqlite(SqliteWriter),
    Mcap(McapWriter),
}

impl Bag2Writer {
    /// Writes SQLite into the folder `path`, which must exist.
    pub fn sqlite(path: &Path, chunk_bytes: usize) -> Result<Self> {
        let file = format!("{}_0.db3", name(path)?);
        let storage = Inner::Sqlite(SqliteWriter::new(&path.join(&file), chunk_bytes)?);
        Ok(Self { folder: path.to_owned(), file, storage, summary: Summary::default() })
    }

    /// Writes MCAP into the folder `path`, which must exist.
    pub fn mcap(path: &Path, compression: Compression, chunk_bytes: usize) -> Result<Self> {
        let file = format!("{}_0.mcap", name(path)?);
        let target = File::create_new(path.join(&file))?;
        let storage = Inner::Mcap(McapWriter::new(target, compression, chunk_bytes));
        Ok(Self { folder: path.to_owned(), file, storage, summary: Summary::default() })
    }
}

impl StorageWriter for Bag2Writer {
    fn add_channel(&mut self, channel: &Channel) -> Result<()> {
        self.summary.add(channel.clone());
        match &mut self.storage {
            Inner::Sqlite(storage) => storage.add_channel(channel),
            Inner::Mcap(storage) => storage.add_channel(channel),
        }
    }

    fn write(&mut self, channel: usize, log_time_ns: i64, publish_time_ns: i64, bytes: &[u8]) -> Result<()> {
        match &mut self.storage {
            Inner::Sqlite(storage) => storage.write(channel, log_time_ns, bytes)?,
            Inner::Mcap(storage) => storage.write(channel, log_time_ns, publish_time_ns, bytes)?,
        }
        self.summary.cover(log_time_ns, log_time_ns);
        self.summary.count(channel, 1);
        Ok(())
    }

    fn flush(&mut self) -> Result<()> {
        match &mut self.storage {
            Inner::Sqlite(storage) => storage.flush(),
            Inner::Mcap(storage) => storage.flush(),
        }
    }

    fn finish(&mut self) -> Result<()> {
        let information = match &mut self.storage {
            Inner::Sqlite(storage) => {
                let information = to_yaml("sqlite3", &self.file, &self.summary);
                storage.finish(&information)?;
                information
            }
            Inner::Mcap(storage) => {
                let information = to_yaml("mcap", &self.file, &self.summary);
                let texts = BTreeMap::from([("serialized_metadata".to_owned(), information.clone())]);
                storage.add_metadata("rosbag2", &texts)?;
                storage.finish()?;
                information
            }
        };
        // The renaming makes the metadata appear complete or not at all.
        let unfinished = self.folder.join("metadata.yaml.tmp");
        fs::write(&unfinished, document(&information))?;
        fs::rename(&unfinished, self.folder.join(METADATA))?;
        Ok(())
    }
}

/// Removes the files of a recording from its folder; other files are kept.
///
/// # Errors
///
/// If the folder contains other files but no recording.
pub(crate) fn remove(folder: &Path) -> Result<()> {
    let mut files = Vec::new();
    let mut others = 0;
    for entry in fs::read_dir(folder).context(|| format!("opening {}", folder.display()))? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let ends = [".db3", ".db3-wal", ".db3-shm", ".db3-journal", ".mcap", ".db3.zstd", ".mcap.zstd"];
        if path.is_file() && (name == METADATA || ends.iter().any(|end| name.ends_with(end))) {
            files.push(path);
        } else {
            others += 1;
        }
    }
    if files.is_empty() && others > 0 {
        let folder = folder.display();
        return Err(Error::invalid_input(format!(
            "{folder} contains other files but no recording, so it is not overwritten: choose another folder"
        )));
    }
    files.iter().try_for_each(fs::remove_file).context(|| format!("overwriting {}", folder.display()))
}

fn name(path: &Path) -> Result<String> {
    let name = path.file_name().and_then(|name| name.to_str());
    let unnamed = || Error::invalid_input(format!("the folder name of {} is not UTF-8", path.display()));
    name.map(str::to_owned).ok_or_else(unnamed)
}
