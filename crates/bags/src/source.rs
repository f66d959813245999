//! Bytes of a recording in a file or in memory, with random access.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;

use bytes::Bytes;
use opendr_engine::{Error, Result, ResultExt};

/// Source of bytes. It is cheap to clone: the readers of a recording share the open file.
#[derive(Clone)]
pub(crate) enum Source {
    File { file: Arc<File>, len: u64 },
    Memory(Bytes),
}

impl Source {
    pub fn open(path: &Path) -> Result<Self> {
        let open = || -> io::Result<Self> {
            let file = File::open(path)?;
            let len = file.metadata()?.len();
            Ok(Self::File { file: Arc::new(file), len })
        };
        open().context(|| format!("opening {}", path.display()))
    }

    pub fn len(&self) -> u64 {
        match self {
            Self::File { len, .. } => *len,
            Self::Memory(bytes) => bytes.len() as u64,
        }
    }

    /// Returns the `len` bytes from `offset`. Memory is allocated only for existing bytes.
    pub fn read(&self, offset: u64, len: u64) -> Result<Bytes> {
        let end = offset.checked_add(len).filter(|end| *end <= self.len()).ok_or_else(|| {
            let size = self.len();
            Error::format(format!(
                "{len} bytes at {offset} are needed, but the file ends at {size}: it is truncated or damaged"
            ))
        })?;
        match self {
            Self::Memory(bytes) => Ok(bytes.slice(offset as usize..end as usize)),
            Self::File { file, .. } => {
                let mut bytes = Vec::with_capacity(len as usize);
                At { file, offset }.take(len).read_to_end(&mut bytes)?;
                if (bytes.len() as u64) < len {
                    return Err(Error::io("the file was truncated while it was read"));
                }
                Ok(bytes.into())
            }
        }
    }
}

/// A file with a read position of its own, independent of other readers.
struct At<'a> {
    file: &'a File,
    offset: u64,
}

impl Read for At<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        #[cfg(unix)]
        let read = std::os::unix::fs::FileExt::read_at(self.file, buffer, self.offset)?;
        #[cfg(windows)]
        let read = std::os::windows::fs::FileExt::seek_read(self.file, buffer, self.offset)?;
        self.offset += read as u64;
        Ok(read)
    }
}

/// A read-ahead buffer for mostly sequential small reads.
pub(crate) struct Window<'a> {
    source: &'a Source,
    start: u64,
    held: Bytes,
}

impl<'a> Window<'a> {
    const SIZE: u64 = 1 << 16;

    pub fn new(source: &'a Source) -> Self {
        Self { source, start: 0, held: Bytes::new() }
    }

    pub fn read(&mut self, offset: u64, len: u64) -> Result<Bytes> {
        let within = offset
            .checked_sub(self.start)
            .filter(|skip| skip.checked_add(len).is_some_and(|end| end <= self.held.len() as u64));
        if let Some(skip) = within {
            return Ok(self.held.slice(skip as usize..(skip + len) as usize));
        }
        if len >= Self::SIZE {
            return self.source.read(offset, len);
        }
        let ahead = Self::SIZE.min(self.source.len().saturating_sub(offset)).max(len);
        self.held = self.source.read(offset, ahead)?;
        self.start = offset;
        Ok(self.held.slice(..len as usize))
    }
}
