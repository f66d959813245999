//! Extraction of members from untrusted archives: member names never become paths, links and names that leave their folder are
//! refused, and the unpacked size is bounded.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek};
use std::path::Path;

use flate2::read::GzDecoder;
use opendr_engine::model::member_path;
use opendr_engine::{Error, Result, ResultExt};
use tar::EntryType;
use zip::ZipArchive;

const MAX_MEMBERS: usize = 200_000;

/// Maximum ratio of unpacked to packed size; weights hardly compress.
const MAX_RATIO: u64 = 20;

/// Selects members by name: returns the size in bytes of a member to extract, `None` for others.
pub(crate) type Select<'a> = &'a dyn Fn(&str) -> Option<u64>;

/// Passes name and bytes of every selected member to `take`, in the archive's order. The format (`.tgz`, `.whl`, `.zip`) is
/// detected from the first bytes.
///
/// # Errors
/// `Integrity` for a damaged or malicious archive, `Format` for other formats, those of `take`.
pub(crate) fn extract(
    archive: &Path,
    select: Select<'_>,
    take: &mut dyn FnMut(&str, Vec<u8>) -> Result<()>,
) -> Result<()> {
    let mut read = || -> Result<()> {
        let mut file = File::open(archive)?;
        let budget = file.metadata()?.len().saturating_mul(MAX_RATIO).saturating_add(1 << 20);
        let mut start = [0; 2];
        file.read_exact(&mut start)?;
        file.rewind()?;
        match &start {
            [0x1f, 0x8b] => extract_tgz(BufReader::new(file), budget, select, take),
            b"PK" => extract_zip(BufReader::new(file), budget, select, take),
            _ => Err(Error::format("neither a .tgz nor a .zip")),
        }
    };
    read().context(|| archive.display().to_string())
}

fn extract_tgz(
    file: BufReader<File>,
    budget: u64,
    select: Select<'_>,
    take: &mut dyn FnMut(&str, Vec<u8>) -> Result<()>,
) -> Result<()> {
    let mut archive = tar::Archive::new(Bounded { reader: GzDecoder::new(file), left: budget });
    for (count, entry) in archive.entries().map_err(damaged)?.enumerate() {
        let entry = entry.map_err(damaged)?;
        check_count(count)?;
        let kind = entry.header().entry_type();
        if kind == EntryType::XGlobalHeader {
            continue;
        }
        let name = String::from_utf8(entry.path_bytes().into_owned())
            .map_err(|_| Error::integrity("a member's name is not UTF-8"))?;
        let name = if kind.is_dir() { name.trim_end_matches('/') } else { &name };
        member_path(name)?;
        if !kind.is_dir() && !kind.is_file() {
            return Err(refused_link(name));
        }
        if let Some(size) = select(name).filter(|_| kind.is_file()) {
            take(name, read_member(entry, name, size)?)?;
        }
    }
    // The checksum of the archive is at its end.
    io::copy(&mut archive.into_inner(), &mut io::sink()).map_err(damaged)?;
    Ok(())
}

fn extract_zip(
    file: BufReader<File>,
    mut budget: u64,
    select: Select<'_>,
    take: &mut dyn FnMut(&str, Vec<u8>) -> Result<()>,
) -> Result<()> {
    let mut archive = ZipArchive::new(file).map_err(|error| damaged(error.into()))?;
    check_count(archive.len())?;
    for index in 0..archive.len() {
        let entry = archive.by_index(index).map_err(|error| damaged(error.into()))?;
        let name = entry.name().map_err(|error| damaged(error.into()))?.into_owned();
        let name = if entry.is_dir() { name.trim_end_matches('/') } else { &name };
        member_path(name)?;
        if entry.is_symlink() {
            return Err(refused_link(name));
        }
        if let Some(size) = select(name).filter(|_| entry.is_file()) {
            budget = budget.checked_sub(size).ok_or_else(endless)?;
            take(name, read_member(entry, name, size)?)?;
        }
    }
    Ok(())
}

fn read_member(entry: impl Read, name: &str, size: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    entry.take(size + 1).read_to_end(&mut bytes).map_err(damaged).context(|| name)?;
    if bytes.len() as u64 == size {
        return Ok(bytes);
    }
    let found = if bytes.len() as u64 > size { format!("over {size}") } else { bytes.len().to_string() };
    Err(Error::integrity(format!("the member {name:?} has {found} bytes instead of {size}")))
}

/// Reader that fails after more than `left` bytes.
struct Bounded<R> {
    reader: R,
    left: u64,
}

impl<R: Read> Read for Bounded<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.reader.read(buffer)?;
        self.left = self.left.checked_sub(count as u64).ok_or_else(|| io::Error::other(endless()))?;
        Ok(count)
    }
}

fn endless() -> Error {
    Error::integrity(format!("the archive unpacks to more than {MAX_RATIO} times its size: refused"))
}

fn check_count(count: usize) -> Result<()> {
    if count <= MAX_MEMBERS {
        return Ok(());
    }
    Err(Error::integrity(format!("the archive has more than {MAX_MEMBERS} members: refused")))
}

fn refused_link(name: &str) -> Error {
    Error::integrity(format!("the member {name:?} is a link or device: refused"))
}

fn damaged(error: io::Error) -> Error {
    Error::integrity("the archive is damaged").with_source(error)
}

#[cfg(test)]
mod tests;
