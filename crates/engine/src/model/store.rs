//! Access to the files of a container, with bounds on their size.

use std::fs::{self, File};
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

use zip::ZipArchive;
use zip::result::ZipError;

use super::member_path;
use crate::{Error, Result, ResultExt};

/// Maximum size of a file of a model, in bytes; the limit of ONNX files.
pub(super) const MAX_FILE_BYTES: u64 = 2 << 30;

#[derive(Debug, Clone)]
pub(super) enum Store {
    Folder(PathBuf),
    /// `prefix` is the only top-level folder of the archive with its slash, or empty.
    Zip {
        path: PathBuf,
        prefix: String,
    },
}

impl Store {
    /// Reads the file `name`, which must have exactly `size` bytes.
    pub(super) fn read_exactly(&self, name: &str, size: u64) -> Result<Vec<u8>> {
        if size > MAX_FILE_BYTES {
            return Err(Error::format(format!(
                "{name:?} is listed with {size} bytes, more than the limit of {MAX_FILE_BYTES}"
            )));
        }
        let found = match self {
            Self::Folder(folder) => length_of(&path_inside(folder, name)?)?,
            Self::Zip { path, prefix } => length_zipped(path, &format!("{prefix}{name}"))?,
        };
        if found != size {
            return Err(wrong_size(name, found, size));
        }
        let bytes = self.read_at_most(name, size)?;
        let found = bytes.len() as u64;
        if found == size { Ok(bytes) } else { Err(wrong_size(name, found, size)) }
    }

    /// Reads the file `name` of at most `limit` bytes.
    pub(super) fn read_at_most(&self, name: &str, limit: u64) -> Result<Vec<u8>> {
        match self {
            Self::Folder(folder) => read_file(&path_inside(folder, name)?, limit),
            Self::Zip { path, prefix } => read_zipped(path, &format!("{prefix}{name}"), limit),
        }
    }
}

fn wrong_size(name: &str, found: u64, expected: u64) -> Error {
    Error::integrity(format!(
        "{name:?} has {found} bytes instead of {expected}: it is damaged or another version; download it again"
    ))
}

fn path_inside(folder: &Path, name: &str) -> Result<PathBuf> {
    let folder = fs::canonicalize(folder).context(|| folder.display().to_string())?;
    let joined = folder.join(member_path(name)?);
    let path = fs::canonicalize(&joined).context(|| joined.display().to_string())?;
    if path.starts_with(&folder) {
        return Ok(path);
    }
    Err(Error::integrity(format!(
        "{name:?} is a link to {}, outside the folder of the model; copy the file into the folder",
        path.display()
    )))
}

fn length_of(path: &Path) -> Result<u64> {
    let found = fs::metadata(path).context(|| path.display().to_string())?;
    // A pipe would block when opened.
    if found.is_file() {
        Ok(found.len())
    } else {
        Err(Error::format(format!("{} is not a file", path.display())))
    }
}

/// Reads a file of at most `limit` bytes.
pub(super) fn read_file(path: &Path, limit: u64) -> Result<Vec<u8>> {
    let length = length_of(path)?;
    let file = File::open(path).context(|| path.display().to_string())?;
    read_bounded(file, length, limit).context(|| path.display().to_string())
}

fn read_bounded(reader: impl Read, length: u64, limit: u64) -> Result<Vec<u8>> {
    let too_large = || Error::format(format!("more than {limit} bytes, the largest size allowed"));
    if length > limit {
        return Err(too_large());
    }
    // A zip may state any length: beyond this limit, the buffer grows with the data read.
    let mut bytes = Vec::with_capacity(length.min(64 << 20) as usize);
    reader.take(limit + 1).read_to_end(&mut bytes).map_err(|error| match error.kind() {
        io::ErrorKind::InvalidData => Error::integrity("damaged; download it again").with_source(error),
        _ => error.into(),
    })?;
    if bytes.len() as u64 > limit { Err(too_large()) } else { Ok(bytes) }
}

fn open_zip(path: &Path) -> Result<ZipArchive<BufReader<File>>> {
    let file = File::open(path).context(|| path.display().to_string())?;
    ZipArchive::new(BufReader::new(file)).map_err(|error| from_zip(path, error))
}

fn from_zip(path: &Path, error: ZipError) -> Error {
    let error = match error {
        ZipError::FileNotFound => Error::not_found("no such file in the archive"),
        error => Error::format("not a readable zip archive").with_source(error),
    };
    error.context(path.display().to_string())
}

fn length_zipped(path: &Path, name: &str) -> Result<u64> {
    let mut archive = open_zip(path)?;
    archive.by_name(name).map(|entry| entry.size()).map_err(|error| from_zip(path, error).context(name))
}

fn read_zipped(path: &Path, name: &str, limit: u64) -> Result<Vec<u8>> {
    let mut archive = open_zip(path)?;
    let entry = archive.by_name(name).map_err(|error| from_zip(path, error).context(name))?;
    if !entry.is_file() {
        return Err(Error::format(format!("{name:?} in {} is not a file", path.display())));
    }
    let length = entry.size();
    read_bounded(entry, length, limit).context(|| format!("{name:?} in {}", path.display()))
}

/// Returns the folder of the archive that contains the file `name`: the top level, or the only folder in it.
pub(super) fn prefix_in_zip(path: &Path, name: &str) -> Result<String> {
    let archive = open_zip(path)?;
    let mut found = archive.file_names().filter_map(|entry| {
        let entry = entry.ok()?;
        let prefix = entry.strip_suffix(name)?;
        let depth = prefix.matches('/').count();
        (prefix.is_empty() || depth == 1 && prefix.ends_with('/')).then(|| (depth, prefix.to_owned()))
    });
    let first = found.next();
    let best = found.fold(first, |best, next| best.min(Some(next)));
    best.map(|(_, prefix)| prefix)
        .ok_or_else(|| Error::format(format!("no {name} in {}; it is not a model", path.display())))
}
