//! Files that are replaced as a whole and synced.

use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

use opendr_engine::Result;
use opendr_engine::atomic_file::replace_file_with;
pub(crate) use opendr_engine::atomic_file::{INCOMPLETE_SUFFIX, temporary_name, write_error};

/// Writes a file atomically: to a temporary file beside `path`, which is synced and renamed. After a crash, `path` has either the
/// old or the new bytes.
///
/// # Errors
/// As [`replace_file`](opendr_engine::atomic_file::replace_file).
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<()> {
    replace_file_with(path, |temporary| write_synced(temporary, bytes))?;
    sync_folder(path).map_err(|error| write_error(path, error))
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
