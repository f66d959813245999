//! Atomic writing of files.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use opendr_engine::{Error, ErrorKind, Result};

static COUNTER: AtomicU64 = AtomicU64::new(0);

/// Writes a file atomically: to a temporary file beside `path`, which is synced and renamed. After a crash, `path` has either the
/// old or the new bytes.
///
/// # Errors
/// `Io` when the disk is full or the folder is not writable, `NotFound` when the folder does not exist, both with the
/// path. The old file is then unchanged, and no temporary file is left.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<()> {
    let written = || {
        let temporary = temporary_name(path)?;
        let placed = write_synced(&temporary, bytes)
            .and_then(|()| fs::rename(&temporary, path))
            .and_then(|()| sync_folder(path));
        if placed.is_err() {
            // The first failure is the one to report.
            fs::remove_file(&temporary).ok();
        }
        placed
    };
    written().map_err(|error| write_error(path, error))
}

/// Suffix of the names of incomplete files.
pub(crate) const INCOMPLETE_SUFFIX: &str = ".partial";

/// Returns a unique hidden name beside `path`.
pub(crate) fn temporary_name(path: &Path) -> io::Result<PathBuf> {
    let name = path.file_name().ok_or_else(|| io::Error::other("the path has no file name"))?;
    let mut temporary = OsString::from(".");
    temporary.push(name);
    let count = COUNTER.fetch_add(1, Ordering::Relaxed);
    temporary.push(format!(".{}.{count}{INCOMPLETE_SUFFIX}", std::process::id()));
    Ok(path.with_file_name(temporary))
}

/// Writes a new file and syncs it.
pub(crate) fn write_synced(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

/// Syncs the folder of `path`, so that its name is on the disk.
pub(crate) fn sync_folder(path: &Path) -> io::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // Other systems cannot open folders, and need no sync for a rename.
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}

/// Returns the error of a failed write to `path`, with advice.
pub(crate) fn write_error(path: &Path, error: io::Error) -> Error {
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
            write_atomically(&path, bytes).unwrap();
            assert_eq!(fs::read(&path).unwrap(), bytes);
        }
        fs::create_dir(folder.join("taken")).unwrap();
        assert_eq!(write_atomically(&folder.join("taken"), b"x").unwrap_err().kind(), ErrorKind::Io);
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn errors_name_the_path() {
        let missing = write_atomically(Path::new("/no/such/folder/state.json"), b"x").unwrap_err();
        assert_eq!(missing.kind(), ErrorKind::NotFound);
        assert!(missing.to_string().contains("/no/such/folder/state.json"), "{missing}");
        assert_eq!(write_atomically(Path::new("/"), b"x").unwrap_err().kind(), ErrorKind::Io);
    }
}
