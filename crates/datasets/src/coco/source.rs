//! Reading of single entries of a COCO file.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use opendr_engine::{JsonPiece, Result, ResultExt};
use serde::Deserialize;

use super::index::{Annotation, Picture};
use super::record::PictureRecord;

/// Largest gap between two entries that are read together, in bytes.
const GAP: u64 = 1 << 12;

/// Most bytes that are read at once, unless one entry is longer.
const MAX_READ: u64 = 1 << 20;

/// An indexed COCO file. Reads are short, so threads share a lock.
#[derive(Debug)]
pub(super) struct Source {
    path: PathBuf,
    file: Mutex<File>,
}

impl Source {
    pub fn new(path: &Path) -> Result<Self> {
        let file = File::open(path).context(|| format!("opening {}", path.display()))?;
        Ok(Self { path: path.to_owned(), file: Mutex::new(file) })
    }

    /// Returns the file name of an image.
    pub fn file_name(&self, picture: &Picture) -> Result<String> {
        let bytes = self.read(picture.offset, picture.length.into())?;
        let record: PictureRecord = self.parse(&bytes, picture.offset)?;
        Ok(record.file_name.into_owned())
    }

    /// Calls `each` with each annotation; nearby annotations are read together.
    pub fn annotations<T: for<'de> Deserialize<'de>>(
        &self,
        mut annotations: &[Annotation],
        mut each: impl FnMut(T) -> Result<()>,
    ) -> Result<()> {
        let end = |annotation: &Annotation| annotation.offset + u64::from(annotation.length);
        while let Some(first) = annotations.first() {
            let near = annotations.windows(2).take_while(|pair| {
                pair[1].offset - end(&pair[0]) <= GAP && end(&pair[1]) - first.offset <= MAX_READ
            });
            let (together, rest) = annotations.split_at(near.count() + 1);
            let bytes = self.read(first.offset, together.last().map_or(0, end) - first.offset)?;
            for annotation in together {
                let start = (annotation.offset - first.offset) as usize;
                each(self.parse(&bytes[start..start + annotation.length as usize], annotation.offset)?)?;
            }
            annotations = rest;
        }
        Ok(())
    }

    fn parse<'a, T: Deserialize<'a>>(&self, bytes: &'a [u8], offset: u64) -> Result<T> {
        let parsed = JsonPiece { bytes, offset, line: 1 }.parse();
        parsed.context(|| format!("{} was modified while it was in use", self.path.display()))
    }

    fn read(&self, offset: u64, length: u64) -> Result<Vec<u8>> {
        let mut bytes = vec![0; length as usize];
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let read = file.seek(SeekFrom::Start(offset)).and_then(|_| file.read_exact(&mut bytes));
        read.context(|| format!("reading {} at byte {offset}", self.path.display()))?;
        Ok(bytes)
    }
}
