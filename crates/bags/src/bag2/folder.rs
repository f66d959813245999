//! A folder of rosbag2: its files as one recording.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use opendr_engine::{Error, Result, ResultExt};
use tempfile::TempDir;

use super::SQLITE_MAGIC;
use super::compressed::decompressed;
use super::metadata::Metadata;
use super::sqlite::Sqlite;
use crate::mcap;
use crate::recorded::{RecordedMessage, Stream};
use crate::selection::Filter;
use crate::source::Source;
use crate::storage::{Storage, Summary};

/// Name of the file with the metadata of the folder.
pub(crate) const METADATA: &str = "metadata.yaml";

/// An opened folder.
pub(crate) struct Folder {
    parts: Arc<Parts>,
    summary: Summary,
    is_sqlite: bool,
}

struct Parts {
    list: Vec<Part>,
    /// Folder of the decompressed files, which is deleted with the last reader.
    _plain: Option<TempDir>,
}

struct Part {
    storage: Box<dyn Storage>,
    /// Channel index in the whole recording for each channel of the file.
    channels: Vec<usize>,
}

impl Folder {
    pub fn open(path: &Path) -> Result<Self> {
        let metadata_path = path.join(METADATA);
        let metadata = metadata_path.exists().then(|| Metadata::read(&metadata_path)).transpose()?;
        let mut files = match &metadata {
            // Old recordings include the folder's name in paths. Only the file name is used, so no path leaves the
            // folder.
            Some(metadata) => {
                metadata.relative_file_paths.iter().filter_map(|file| inside(path, file)).collect()
            }
            None => files_of(path)?,
        };
        if files.is_empty() {
            let folder = path.display();
            return Err(Error::format(format!("{folder} contains no files of a recording (.db3, .mcap)")));
        }
        let mut plain = None;
        if metadata.as_ref().is_some_and(|metadata| metadata.is_compressed_by("file")) {
            known_compression(metadata.as_ref())?;
            let folder = plain.insert(TempDir::with_prefix("opendr-bags")?);
            files = files.iter().map(|file| decompressed(file, folder)).collect::<Result<_>>()?;
        }
        let is_zstd = metadata.as_ref().is_some_and(|metadata| metadata.is_compressed_by("message"));
        if is_zstd {
            known_compression(metadata.as_ref())?;
        }
        let mut folder = Self::from_files(&files, is_zstd, plain)?;
        folder.summary.is_complete = metadata.is_some() && folder.summary.is_complete;
        for channel in folder.summary.channels.iter_mut().filter(|channel| channel.type_hash.is_none()) {
            channel.type_hash = metadata.as_ref().and_then(|metadata| metadata.type_hash(channel));
        }
        Ok(folder)
    }

    /// Returns whether the storage is SQLite.
    pub fn is_sqlite(&self) -> bool {
        self.is_sqlite
    }

    fn from_files(files: &[PathBuf], is_zstd: bool, plain: Option<TempDir>) -> Result<Self> {
        let mut summary = Summary { is_complete: true, ..Summary::default() };
        let mut list = Vec::new();
        let mut is_sqlite = false;
        for file in files {
            let source = Source::open(file)?;
            let start = source.read(0, source.len().min(16))?;
            let storage: Box<dyn Storage> = if start == SQLITE_MAGIC {
                is_sqlite = true;
                Box::new(Sqlite::open(file, is_zstd)?)
            } else if start.starts_with(mcap::MAGIC) && !is_zstd {
                Box::new(mcap::open(source).context(|| format!("reading {}", file.display()))?)
            } else {
                let file = file.display();
                return Err(Error::unsupported(format!(
                    "{file} is neither SQLite nor MCAP, the supported storages"
                )));
            };
            let part = storage.summary();
            // Without a metadata table in SQLite, the folder's metadata alone states that the recording is
            // complete.
            summary.is_complete &= part.is_complete || is_sqlite;
            if let Some((start, end)) = part.span {
                summary.cover(start, end);
            }
            let mut channels = Vec::new();
            for (channel, count) in part.channels.iter().zip(&part.counts) {
                let known = summary.channels.iter().position(|other| other == channel);
                let index = known.unwrap_or_else(|| summary.add(channel.clone()));
                summary.count(index, *count);
                channels.push(index);
            }
            list.push(Part { storage, channels });
        }
        Ok(Self { parts: Arc::new(Parts { list, _plain: plain }), summary, is_sqlite })
    }
}

impl Storage for Folder {
    fn summary(&self) -> &Summary {
        &self.summary
    }

    fn messages(&self, filter: Filter) -> Result<Stream> {
        let start = |part: &Part| part.storage.summary().span;
        let mut upcoming: Vec<_> =
            self.parts.list.iter().enumerate().filter_map(|(at, part)| Some((start(part)?.0, at))).collect();
        if !filter.in_file_order {
            upcoming.sort_unstable();
        }
        upcoming.reverse();
        let streams = self.parts.list.iter().map(|_| None).collect();
        Ok(Box::new(Merged {
            parts: self.parts.clone(),
            filter,
            upcoming,
            streams,
            heads: BinaryHeap::new(),
        }))
    }
}

/// Merges the messages of all files in order. A file is opened when its first message may be the next one.
struct Merged {
    parts: Arc<Parts>,
    filter: Filter,
    upcoming: Vec<(i64, usize)>,
    streams: Vec<Option<(Stream, Option<RecordedMessage>)>>,
    heads: BinaryHeap<Reverse<(i64, usize)>>,
}

impl Merged {
    fn step(&mut self) -> Result<Option<RecordedMessage>> {
        while let Some(&(start, at)) = self.upcoming.last() {
            let is_early = self.heads.peek().is_some_and(|Reverse((time, _))| *time < start);
            if is_early || (self.filter.in_file_order && !self.heads.is_empty()) {
                break;
            }
            self.upcoming.pop();
            if let Some(part) = self.parts.list.get(at) {
                let channels = part.channels.iter().map(|channel| self.filter.channel(*channel)).collect();
                let stream = part.storage.messages(Filter { channels, ..self.filter.clone() })?;
                self.advance(at, stream)?;
            }
        }
        let Some(Reverse((_, at))) = self.heads.pop() else { return Ok(None) };
        let Some((stream, Some(mut message))) = self.streams.get_mut(at).and_then(Option::take) else {
            return Ok(None);
        };
        self.advance(at, stream)?;
        let channels = self.parts.list.get(at).map(|part| &part.channels[..]).unwrap_or_default();
        message.channel = channels.get(message.channel).copied().unwrap_or_default();
        Ok(Some(message))
    }

    fn advance(&mut self, at: usize, mut stream: Stream) -> Result<()> {
        let Some(message) = stream.next().transpose()? else { return Ok(()) };
        // In file order, only one file is open.
        self.heads.push(Reverse((message.log_time_ns, at)));
        if let Some(slot) = self.streams.get_mut(at) {
            *slot = Some((stream, Some(message)));
        }
        Ok(())
    }
}

impl Iterator for Merged {
    type Item = Result<RecordedMessage>;

    fn next(&mut self) -> Option<Self::Item> {
        self.step().transpose()
    }
}

fn inside(folder: &Path, file: &str) -> Option<PathBuf> {
    Some(folder.join(Path::new(file).file_name()?))
}

fn known_compression(metadata: Option<&Metadata>) -> Result<()> {
    let format = metadata.and_then(|metadata| metadata.compression_format.as_deref()).unwrap_or_default();
    if format == "zstd" {
        return Ok(());
    }
    Err(Error::unsupported(format!(
        "the recording is compressed with {format:?}; only zstd is supported: decompress it with `ros2 bag convert`"
    )))
}

/// Returns the files of a recording without metadata, in the order of their numbers.
fn files_of(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).context(|| format!("opening {}", folder.display()))? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "db3" || extension == "mcap") {
            files.push(path);
        }
    }
    files.sort_by_key(|path| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let number = name.rsplit('_').next().and_then(|number| number.parse::<u64>().ok());
        (number, name)
    });
    Ok(files)
}
