//! Where a recording's bytes are: a file or memory, read at any place.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;

use bytes::Bytes;
use opendr_engine::{Error, Result, ResultExt};

/// Cheap to clone: readers of one recording share the open file.
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

    /// The `len` bytes from `offset`; nothing is allocated for bytes that are not there.
    pub fn read(&self, offset: u64, len: u64) -> Result<Bytes> {
        let end = offset.checked_add(len).filter(|end| *end <= self.len()).ok_or_else(|| {
            let size = self.len();
            Error::format(format!("{len} bytes at {offset} are told of, but the file ends at {size}"))
        })?;
        match self {
            Self::Memory(bytes) => Ok(bytes.slice(offset as usize..end as usize)),
            Self::File { file, .. } => {
                let mut bytes = Vec::with_capacity(len as usize);
                At { file, offset }.take(len).read_to_end(&mut bytes)?;
                if (bytes.len() as u64) < len {
                    return Err(Error::io("the file became shorter while it was read"));
                }
                Ok(bytes.into())
            }
        }
    }
}

/// A file read from a place of its own, not the one that its other readers move.
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

/// A source read mostly forwards in small pieces.
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
