//! Files that are replaced as a whole.

use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use crate::{Error, ErrorKind, Result};

static COUNTER: AtomicU64 = AtomicU64::new(0);

/// Writes a file through a temporary file beside `path`, which is renamed: when the process is killed, `path` has either the old or
/// the new bytes. The bytes are not synced; after a power failure the file may be empty (`opendr_runlog::write_atomically` syncs).
///
/// # Errors
/// `Io` when the disk is full or the folder is not writable, `NotFound` when the folder does not exist, both with the
/// path. The old file is then unchanged, and no temporary file is left.
pub fn replace_file(path: &Path, bytes: &[u8]) -> Result<()> {
    replace_file_with(path, |temporary| fs::write(temporary, bytes))
}

/// As [`replace_file`], with a temporary file that `write` writes at the path that it receives.
///
/// # Errors
/// As [`replace_file`], and those of `write`.
pub fn replace_file_with(path: &Path, write: impl FnOnce(&Path) -> io::Result<()>) -> Result<()> {
    let replace = || {
        let temporary = temporary_name(path)?;
        let placed = write(&temporary).and_then(|()| fs::rename(&temporary, path));
        if placed.is_err() {
            // The first failure is the one to report.
            fs::remove_file(&temporary).ok();
        }
        placed
    };
    replace().map_err(|error| write_error(path, error))
}

/// Suffix of the names of incomplete files.
pub const INCOMPLETE_SUFFIX: &str = ".partial";

/// Returns a unique hidden name beside `path`.
pub fn temporary_name(path: &Path) -> io::Result<PathBuf> {
    let name = path.file_name().ok_or_else(|| io::Error::other("the path has no file name"))?;
    let mut temporary = OsString::from(".");
    temporary.push(name);
    let count = COUNTER.fetch_add(1, Ordering::Relaxed);
    temporary.push(format!(".{}.{count}{INCOMPLETE_SUFFIX}", std::process::id()));
    Ok(path.with_file_name(temporary))
}

/// Returns the error of a failed write to `path`, with advice.
pub fn write_error(path: &Path, error: io::Error) -> Error {
    use io::ErrorKind as Kind;
    let advice = match error.kind() {
        Kind::StorageFull | Kind::QuotaExceeded | Kind::FileTooLarge => {
            ": the disk or the user's quota is full; free some space and resume"
        }
        Kind::PermissionDenied | Kind::ReadOnlyFilesystem | Kind::NotADirectory => {
            ": use a folder that may be written"
        }
        Kind::NotFound => ": its folder does not exist",
        _ => "",
    };
    let kind = match error.kind() {
        Kind::NotFound => ErrorKind::NotFound,
        _ => ErrorKind::Io,
    };
    Error::new(kind, format!("cannot write {}{advice}", path.display())).with_source(error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_a_file_and_leaves_nothing_beside_it() {
        let folder = std::env::temp_dir().join(format!("opendr-atomic-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("state.json");
        for bytes in [&b"old"[..], b"", b"new and longer"] {
            replace_file(&path, bytes).unwrap();
            assert_eq!(fs::read(&path).unwrap(), bytes);
        }
        fs::create_dir(folder.join("taken")).unwrap();
        assert_eq!(replace_file(&folder.join("taken"), b"x").unwrap_err().kind(), ErrorKind::Io);
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn errors_name_the_path() {
        let missing = replace_file(Path::new("/no/such/folder/state.json"), b"x").unwrap_err();
        assert_eq!(missing.kind(), ErrorKind::NotFound);
        assert!(missing.to_string().contains("/no/such/folder/state.json"), "{missing}");
        assert_eq!(replace_file(Path::new("/"), b"x").unwrap_err().kind(), ErrorKind::Io);
    }
}
