//! Reading of recordings of any format.

use std::fmt;
use std::path::Path;

use bytes::Bytes;
use opendr_engine::{Error, Result, ResultExt};

use crate::bag1;
use crate::bag2::{Folder, SQLITE_MAGIC, Sqlite};
use crate::channel::Channel;
use crate::format::BagFormat;
use crate::mcap;
use crate::recorded::{RecordedMessage, Stream};
use crate::selection::{Filter, Selection};
use crate::source::Source;
use crate::storage::Storage;

/// An opened recording.
///
/// Its properties come from the index of the file. A recording whose writer was interrupted has no index: its
/// messages are found by reading the file once, and [`Bag::is_complete`] returns false.
pub struct Bag {
    format: BagFormat,
    storage: Box<dyn Storage>,
}

impl Bag {
    /// Opens the recording at `path`: a folder of rosbag2, or a `.bag`, `.mcap` or `.db3` file. The content decides
    /// the format, not the name.
    ///
    /// # Errors
    ///
    /// [`NotFound`](opendr_engine::ErrorKind::NotFound) if the path does not exist,
    /// [`Format`](opendr_engine::ErrorKind::Format) if it is not a recording or too damaged to read anything, and
    /// [`Unsupported`](opendr_engine::ErrorKind::Unsupported) for encryption, older formats and unknown
    /// compression.
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        if path.is_dir() {
            let folder = Folder::open(path)?;
            let format = if folder.is_sqlite() { BagFormat::Bag2Sqlite } else { BagFormat::Bag2Mcap };
            return Ok(Self { format, storage: Box::new(folder) });
        }
        let source = Source::open(path)?;
        let start = source.read(0, source.len().min(SQLITE_MAGIC.len() as u64))?;
        if start == SQLITE_MAGIC {
            let storage = Box::new(Sqlite::open(path, false)?);
            return Ok(Self { format: BagFormat::Bag2Sqlite, storage });
        }
        Self::from_source(source).context(|| format!("reading {}", path.display()))
    }

    /// Opens a `.bag` or `.mcap` file that is in memory.
    ///
    /// # Errors
    ///
    /// As [`Bag::open`].
    pub fn from_bytes(bytes: impl Into<Bytes>) -> Result<Self> {
        Self::from_source(Source::Memory(bytes.into()))
    }

    fn from_source(source: Source) -> Result<Self> {
        let start = source.read(0, source.len().min(16))?;
        if start.starts_with(bag1::MAGIC) {
            Ok(Self { format: BagFormat::Bag1, storage: Box::new(bag1::open(source)?) })
        } else if start.starts_with(mcap::MAGIC) {
            Ok(Self { format: BagFormat::Mcap, storage: Box::new(mcap::open(source)?) })
        } else if start.starts_with(b"#ROS") {
            Err(Error::unsupported(
                "a format older than rosbag 2.0: convert it with `rosbag fix` and `rosbag reindex`",
            ))
        } else {
            Err(Error::format("not a recording: the file does not start like rosbag 1, MCAP or SQLite"))
        }
    }

    /// Returns the format of the recording.
    pub fn format(&self) -> BagFormat {
        self.format
    }

    /// Returns the channels; [`RecordedMessage::channel`] is an index into them.
    pub fn channels(&self) -> &[Channel] {
        &self.storage.summary().channels
    }

    /// Returns the number of messages of each channel, as stated by the index.
    pub fn message_counts(&self) -> &[u64] {
        &self.storage.summary().counts
    }

    /// Returns the number of messages of all channels, as stated by the index. It may be wrong in a damaged file:
    /// do not allocate by it.
    pub fn message_count(&self) -> u64 {
        self.message_counts().iter().fold(0, |sum, count| sum.saturating_add(*count))
    }

    /// Returns the log time of the first message in nanoseconds, or `None` without messages.
    pub fn start_ns(&self) -> Option<i64> {
        self.storage.summary().span.map(|(start, _)| start)
    }

    /// Returns the log time of the last message in nanoseconds, or `None` without messages.
    pub fn end_ns(&self) -> Option<i64> {
        self.storage.summary().span.map(|(_, end)| end)
    }

    /// Returns whether the writer finished the recording: false after a crash or for a truncated file.
    pub fn is_complete(&self) -> bool {
        self.storage.summary().is_complete
    }

    /// Returns all messages in order of their log time; messages of the same time keep the order of the file.
    ///
    /// # Errors
    ///
    /// [`Io`](opendr_engine::ErrorKind::Io) if the file cannot be opened again.
    pub fn messages(&self) -> Result<Messages> {
        self.select(&Selection::default())
    }

    /// Returns the messages of `selection`. Parts of the file without such messages are not read.
    ///
    /// # Errors
    ///
    /// As [`Bag::messages`].
    pub fn select(&self, selection: &Selection) -> Result<Messages> {
        let wants = |channel: &Channel| {
            selection.topics.as_ref().is_none_or(|topics| topics.contains(&channel.topic))
        };
        let channels = self.channels().iter().map(wants).collect();
        let (times, in_file_order) = (selection.times(), selection.in_file_order);
        let stream = self.storage.messages(Filter { channels, times, in_file_order })?;
        Ok(Messages { stream: Some(stream) })
    }
}

impl fmt::Debug for Bag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut bag = f.debug_struct("Bag");
        bag.field("format", &self.format).field("channels", &self.channels().len());
        bag.field("messages", &self.message_count()).finish_non_exhaustive()
    }
}

/// Iterator over the messages of a recording, independent of its [`Bag`]. It ends after the first error.
pub struct Messages {
    stream: Option<Stream>,
}

impl Iterator for Messages {
    type Item = Result<RecordedMessage>;

    fn next(&mut self) -> Option<Self::Item> {
        let item = self.stream.as_mut()?.next();
        if !matches!(item, Some(Ok(_))) {
            self.stream = None;
        }
        item
    }
}

impl std::iter::FusedIterator for Messages {}

impl fmt::Debug for Messages {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Messages").field("is_ended", &self.stream.is_none()).finish()
    }
}
