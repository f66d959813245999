//! Locks between processes that share a cache.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::Path;
use std::time::Duration;

use opendr_engine::{Progress, Result, ResultExt};

use crate::stopped;

/// A lock, held until dropped; the system releases it when the process ends.
#[derive(Debug)]
pub(crate) struct Lock {
    _file: File,
}

impl Lock {
    /// Waits for the lock file at `path`.
    pub(crate) fn acquire(path: &Path, what: &str, progress: &dyn Progress) -> Result<Self> {
        let file = open(path).context(|| path.display().to_string())?;
        let mut noted = false;
        loop {
            match file.try_lock() {
                Ok(()) => return Ok(Self { _file: file }),
                Err(TryLockError::WouldBlock) => {
                    if !noted {
                        progress.note(&format!("waiting for another process that downloads {what}"));
                        noted = true;
                    }
                    if progress.stopped() {
                        return Err(stopped());
                    }
                    std::thread::sleep(Duration::from_millis(50));
                }
                // Some network file systems have no locks; renames keep the cache consistent there too.
                Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {
                    return Ok(Self { _file: file });
                }
                Err(TryLockError::Error(error)) => {
                    return Err(error).context(|| format!("locking {}", path.display()));
                }
            }
        }
    }

    /// Returns the lock, or `None` when another process holds it.
    pub(crate) fn try_acquire(path: &Path) -> Option<Self> {
        let file = open(path).ok()?;
        file.try_lock().ok()?;
        Some(Self { _file: file })
    }
}

fn open(path: &Path) -> io::Result<File> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    File::options().create(true).truncate(false).write(true).open(path)
}
