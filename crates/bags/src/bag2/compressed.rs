//! Files of a recording that are compressed as a whole: they are decompressed into a temporary folder.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result, ResultExt};
use tempfile::TempDir;

/// Largest decompressed size of a file: 256 GiB.
const MAX_BYTES: u64 = 1 << 38;

/// Decompresses `path`, which ends in `.zstd`, into `folder`.
pub(super) fn decompressed(path: &Path, folder: &TempDir) -> Result<PathBuf> {
    let name = path.file_stem().ok_or_else(|| Error::format("a compressed file has no name"))?;
    let plain = folder.path().join(name);
    let write = || -> io::Result<u64> {
        let source = BufReader::with_capacity(1 << 17, File::open(path)?);
        let decoder = ruzstd::decoding::StreamingDecoder::new(source).map_err(io::Error::other)?;
        let mut target = BufWriter::with_capacity(1 << 17, File::create(&plain)?);
        let len = io::copy(&mut decoder.take(MAX_BYTES), &mut target)?;
        target.flush()?;
        Ok(len)
    };
    let context = || format!("decompressing {} (`zstd -d` decompresses it permanently)", path.display());
    // The decoder reports damaged data as `Other`.
    let written = write().map_err(|error| match error.kind() {
        io::ErrorKind::Other | io::ErrorKind::UnexpectedEof => {
            Error::format("the file is damaged").with_source(error)
        }
        _ => error.into(),
    });
    if written.context(context)? == MAX_BYTES {
        return Err(Error::unsupported(format!("{} is larger than {MAX_BYTES} bytes", path.display())));
    }
    Ok(plain)
}
