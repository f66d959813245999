//! Writing of recordings of any format.

use std::fmt;
use std::fs::{self, File};
use std::path::Path;

use opendr_engine::{Error, ErrorKind, Result, ResultExt};

use crate::bag1::Bag1Writer;
use crate::bag2::{Bag2Writer, remove};
use crate::channel::{Channel, Encoding};
use crate::compression::{Compression, MAX_BYTES};
use crate::format::BagFormat;
use crate::mcap::McapWriter;
use crate::recorded::RecordedMessage;
use crate::storage::StorageWriter;

/// Options of a recording that is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WriteOptions {
    /// Format of the recording.
    pub format: BagFormat,
    /// Whether an existing recording is replaced; otherwise an existing one is an error.
    pub overwrite: bool,
    /// Compression of chunks; rosbag 2 with SQLite does not support any.
    pub compression: Compression,
    /// Bytes of messages that are buffered and written together. Buffered messages are lost in a crash.
    pub chunk_bytes: usize,
}

impl WriteOptions {
    /// Returns the options for `format`: no overwriting, no compression, chunks of 1 MiB.
    pub fn new(format: BagFormat) -> Self {
        Self { format, overwrite: false, compression: Compression::None, chunk_bytes: 1 << 20 }
    }
}

impl From<BagFormat> for WriteOptions {
    fn from(format: BagFormat) -> Self {
        Self::new(format)
    }
}

/// A recording being written. After a system error, every further write fails. A dropped writer finishes the
/// recording, but ignores errors: use [`BagWriter::finish`].
pub struct BagWriter {
    format: BagFormat,
    channels: Vec<Channel>,
    storage: Option<Box<dyn StorageWriter>>,
}

impl BagWriter {
    /// Creates a recording at `path`: a file, or a folder for rosbag 2. Takes a [`BagFormat`] or [`WriteOptions`].
    ///
    /// # Errors
    ///
    /// [`InvalidInput`](opendr_engine::ErrorKind::InvalidInput) if the path exists and may not be overwritten,
    /// [`InvalidParam`](opendr_engine::ErrorKind::InvalidParam) for a compression that the format does not support,
    /// and [`Io`](opendr_engine::ErrorKind::Io) if it cannot be written.
    pub fn create(path: impl AsRef<Path>, options: impl Into<WriteOptions>) -> Result<Self> {
        let (path, options) = (path.as_ref(), options.into());
        let storage = start(path, &options).context(|| format!("writing {}", path.display()))?;
        Ok(Self { format: options.format, channels: Vec::new(), storage: Some(storage) })
    }

    /// Adds a channel and returns its number for [`BagWriter::write`], counted from 0.
    ///
    /// # Errors
    ///
    /// [`Unsupported`](opendr_engine::ErrorKind::Unsupported) if the format does not support the encoding: rosbag 1
    /// supports ROS 1's, rosbag 2 CDR, MCAP both.
    pub fn add_channel(&mut self, channel: Channel) -> Result<usize> {
        let is_kept = match channel.encoding {
            Encoding::Ros1 => !self.format.is_folder(),
            Encoding::Cdr => self.format != BagFormat::Bag1,
            Encoding::Other(_) => false,
        };
        if !is_kept {
            let Channel { topic, encoding, .. } = &channel;
            return Err(Error::unsupported(format!(
                "{topic} has messages of encoding {encoding}, which {} does not support: convert or exclude them",
                self.format
            )));
        }
        self.with_storage(|storage| storage.add_channel(&channel))?;
        self.channels.push(channel);
        Ok(self.channels.len() - 1)
    }

    /// Returns the channels added so far.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Writes a message whose publish time is its log time, in nanoseconds.
    ///
    /// # Errors
    ///
    /// [`InvalidInput`](opendr_engine::ErrorKind::InvalidInput) for an unknown channel, a message of more than 1
    /// GiB and a time that the format does not support (before 1970; rosbag 1: 0 and after 2106), and
    /// [`Io`](opendr_engine::ErrorKind::Io) if the disk is full.
    pub fn write(&mut self, channel: usize, log_time_ns: i64, bytes: &[u8]) -> Result<()> {
        self.write_published(channel, log_time_ns, log_time_ns, bytes)
    }

    /// Writes a message that was read from a recording, on `channel` of this one.
    ///
    /// # Errors
    ///
    /// As [`BagWriter::write`].
    pub fn copy(&mut self, channel: usize, message: &RecordedMessage) -> Result<()> {
        let log_time_ns = message.log_time_ns;
        self.write_published(
            channel,
            log_time_ns,
            message.publish_time_ns.unwrap_or(log_time_ns),
            &message.bytes,
        )
    }

    fn write_published(&mut self, channel: usize, log: i64, publish: i64, bytes: &[u8]) -> Result<()> {
        let known = self.channels.len();
        if channel >= known {
            return Err(Error::invalid_input(format!(
                "channel {channel} of {known} does not exist: add it first"
            )));
        }
        if bytes.len() as u64 > MAX_BYTES / 2 {
            let len = bytes.len();
            return Err(Error::invalid_input(format!(
                "a message of {len} bytes: the limit is {}",
                MAX_BYTES / 2
            )));
        }
        self.with_storage(|storage| storage.write(channel, log, publish, bytes))
    }

    /// Passes buffered messages to the operating system, so that they survive a crash and other readers see them.
    ///
    /// # Errors
    ///
    /// [`Io`](opendr_engine::ErrorKind::Io) if the disk is full.
    pub fn flush(&mut self) -> Result<()> {
        self.with_storage(|storage| storage.flush())
    }

    /// Writes the remaining messages and the index.
    ///
    /// # Errors
    ///
    /// As [`BagWriter::flush`].
    pub fn finish(mut self) -> Result<()> {
        self.storage.take().map_or(Ok(()), |mut storage| storage.finish())
    }

    /// Drops the storage after a write error, so that the recording is left as after an interruption.
    fn with_storage(&mut self, work: impl FnOnce(&mut dyn StorageWriter) -> Result<()>) -> Result<()> {
        let storage = self.storage.as_deref_mut();
        let done =
            work(storage.ok_or_else(|| Error::io("the recording cannot be written after an earlier error"))?);
        if done.as_ref().is_err_and(|error| error.kind() != ErrorKind::InvalidInput) {
            self.storage = None;
        }
        done
    }
}

impl Drop for BagWriter {
    fn drop(&mut self) {
        if let Some(mut storage) = self.storage.take() {
            storage.finish().ok();
        }
    }
}

impl fmt::Debug for BagWriter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut writer = f.debug_struct("BagWriter");
        writer.field("format", &self.format).field("channels", &self.channels.len()).finish_non_exhaustive()
    }
}

fn start(path: &Path, options: &WriteOptions) -> Result<Box<dyn StorageWriter>> {
    let WriteOptions { format, overwrite, compression, chunk_bytes } = *options;
    if format == BagFormat::Bag2Sqlite && compression != Compression::None {
        return Err(Error::invalid_param("rosbag 2 with SQLite does not support compression: use bag2_mcap"));
    }
    // Readers limit the size of chunks.
    let chunk_bytes = chunk_bytes.min(1 << 28);
    if path.exists() && !overwrite {
        return Err(Error::invalid_input("the path exists already: choose another name, or overwrite"));
    }
    if format.is_folder() {
        if path.is_dir() {
            remove(path)?;
        }
        fs::create_dir_all(path)?;
        return Ok(match format {
            BagFormat::Bag2Sqlite => Box::new(Bag2Writer::sqlite(path, chunk_bytes)?),
            _ => Box::new(Bag2Writer::mcap(path, compression, chunk_bytes)?),
        });
    }
    let file = if overwrite { File::create(path)? } else { File::create_new(path)? };
    Ok(match format {
        BagFormat::Bag1 => Box::new(Bag1Writer::new(file, compression, chunk_bytes)?),
        _ => Box::new(McapWriter::new(file, compression, chunk_bytes)),
    })
}
