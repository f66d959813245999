//! Files of a recording that are compressed whole: their plain form beside the system's other temporary files.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result, ResultExt};
use tempfile::TempDir;

/// No file becomes larger than this: 256 GiB.
const LARGEST: u64 = 1 << 38;

/// The plain form of `path`, which ends in `.zstd`, in `folder`.
pub(super) fn decompressed(path: &Path, folder: &TempDir) -> Result<PathBuf> {
    let name = path.file_stem().ok_or_else(|| Error::format("a compressed file without a name"))?;
    let plain = folder.path().join(name);
    let write = || -> io::Result<u64> {
        let source = BufReader::with_capacity(1 << 17, File::open(path)?);
        let decoder = ruzstd::decoding::StreamingDecoder::new(source).map_err(io::Error::other)?;
        let mut target = BufWriter::with_capacity(1 << 17, File::create(&plain)?);
        let len = io::copy(&mut decoder.take(LARGEST), &mut target)?;
        target.flush()?;
        Ok(len)
    };
    let context = || format!("decompressing {} (`zstd -d` does it for good)", path.display());
    // What the decoder refuses is of no kind of the system's.
    let written = write().map_err(|error| match error.kind() {
        io::ErrorKind::Other | io::ErrorKind::UnexpectedEof => {
            Error::format("the file is damaged").with_source(error)
        }
        _ => error.into(),
    });
    if written.context(context)? == LARGEST {
        return Err(Error::unsupported(format!("{} is larger than {LARGEST} bytes", path.display())));
    }
    Ok(plain)
}
