//! Recordings of any format, written.

use std::fmt;
use std::fs::{self, File};
use std::path::Path;

use opendr_engine::{Error, ErrorKind, Result, ResultExt};

use crate::bag1::Bag1Writer;
use crate::bag2::{Bag2Writer, remove};
use crate::channel::{Channel, Encoding};
use crate::compression::{Compression, LARGEST};
use crate::format::BagFormat;
use crate::mcap::McapWriter;
use crate::recorded::Recorded;
use crate::storage::StorageWriter;

/// How a recording is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WriteOptions {
    /// The format.
    pub format: BagFormat,
    /// An existing recording is replaced; otherwise it is an error that one is there.
    pub overwrite: bool,
    /// How chunks are compressed; rosbag 2 with SQLite has no chunks and is never compressed.
    pub compression: Compression,
    /// Messages of about so many bytes are held back and written together; what is held back is lost in a crash.
    pub chunk_bytes: usize,
}

impl WriteOptions {
    /// Of `format`: nothing is overwritten or compressed, chunks of 1 MiB.
    pub fn new(format: BagFormat) -> Self {
        Self { format, overwrite: false, compression: Compression::None, chunk_bytes: 1 << 20 }
    }
}

impl From<BagFormat> for WriteOptions {
    fn from(format: BagFormat) -> Self {
        Self::new(format)
    }
}

/// A recording being written. After an error of the system nothing more is written to it. Dropped without [`BagWriter::finish`], it is finished as far as that works, without
/// a word of what did not.
pub struct BagWriter {
    format: BagFormat,
    channels: Vec<Channel>,
    storage: Option<Box<dyn StorageWriter>>,
}

impl BagWriter {
    /// Starts a recording at `path`: a file, or a folder for rosbag 2. Takes a [`BagFormat`] or [`WriteOptions`].
    ///
    /// # Errors
    ///
    /// [`InvalidInput`](opendr_engine::ErrorKind::InvalidInput) when something is there that may not be
    /// overwritten, [`InvalidParam`](opendr_engine::ErrorKind::InvalidParam) for a compression that the format
    /// does not have, and [`Io`](opendr_engine::ErrorKind::Io) when it cannot be written.
    pub fn create(path: impl AsRef<Path>, options: impl Into<WriteOptions>) -> Result<Self> {
        let (path, options) = (path.as_ref(), options.into());
        let storage = start(path, &options).context(|| format!("writing {}", path.display()))?;
        Ok(Self { format: options.format, channels: Vec::new(), storage: Some(storage) })
    }

    /// Adds a channel; its number for [`BagWriter::write`], from 0 on.
    ///
    /// # Errors
    ///
    /// [`Unsupported`](opendr_engine::ErrorKind::Unsupported) when the format does not keep messages of its
    /// encoding: rosbag 1 keeps ROS 1's, rosbag 2 CDR, MCAP both.
    pub fn add_channel(&mut self, channel: Channel) -> Result<usize> {
        let is_kept = match channel.encoding {
            Encoding::Ros1 => !self.format.is_folder(),
            Encoding::Cdr => self.format != BagFormat::Bag1,
            Encoding::Other(_) => false,
        };
        if !is_kept {
            let Channel { topic, encoding, .. } = &channel;
            return Err(Error::unsupported(format!(
                "{topic} has messages of encoding {encoding}, which {} does not keep: convert them or leave it out",
                self.format
            )));
        }
        self.with_storage(|storage| storage.add_channel(&channel))?;
        self.channels.push(channel);
        Ok(self.channels.len() - 1)
    }

    /// The channels so far.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Writes a message, published when it was logged.
    ///
    /// # Errors
    ///
    /// [`InvalidInput`](opendr_engine::ErrorKind::InvalidInput) for a channel that was not added, a message of more
    /// than 1 GiB and a time that the format does not keep (before 1970; rosbag 1: 0 and after 2106), and
    /// [`Io`](opendr_engine::ErrorKind::Io) when the disk is full.
    pub fn write(&mut self, channel: usize, log_time_ns: i64, bytes: &[u8]) -> Result<()> {
        self.write_published(channel, log_time_ns, log_time_ns, bytes)
    }

    /// Writes a message that was read, in `channel` of this recording.
    ///
    /// # Errors
    ///
    /// As [`BagWriter::write`].
    pub fn copy(&mut self, channel: usize, message: &Recorded) -> Result<()> {
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
            return Err(Error::invalid_input(format!("channel {channel} of {known}: add it first")));
        }
        if bytes.len() as u64 > LARGEST / 2 {
            let len = bytes.len();
            return Err(Error::invalid_input(format!(
                "a message of {len} bytes: at most {} are kept",
                LARGEST / 2
            )));
        }
        self.with_storage(|storage| storage.write(channel, log, publish, bytes))
    }

    /// Hands to the operating system what was held back, so that a crash or another reader finds it.
    ///
    /// # Errors
    ///
    /// [`Io`](opendr_engine::ErrorKind::Io) when the disk is full.
    pub fn flush(&mut self) -> Result<()> {
        self.with_storage(|storage| storage.flush())
    }

    /// Writes the rest and the index.
    ///
    /// # Errors
    ///
    /// As [`BagWriter::flush`].
    pub fn finish(mut self) -> Result<()> {
        self.storage.take().map_or(Ok(()), |mut storage| storage.finish())
    }

    /// A recording of which a part could not be written is left as one that was cut off.
    fn with_storage(&mut self, work: impl FnOnce(&mut dyn StorageWriter) -> Result<()>) -> Result<()> {
        let storage = self.storage.as_deref_mut();
        let done = work(storage.ok_or_else(|| Error::io("nothing is written after the error before"))?);
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
        return Err(Error::invalid_param("rosbag 2 with SQLite is not compressed: take bag2_mcap"));
    }
    // Chunks have to stay below what readers take.
    let chunk_bytes = chunk_bytes.min(1 << 28);
    if path.exists() && !overwrite {
        return Err(Error::invalid_input("it is there already: choose another name, or overwrite"));
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
