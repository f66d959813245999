//! Temporary folders of downloads.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use opendr_engine::{Progress, Result, ResultExt};

use crate::lock::Lock;

/// A temporary folder, removed when dropped; that of a killed process is removed by the next process that creates one.
#[derive(Debug)]
pub(crate) struct WorkFolder {
    path: PathBuf,
    lock: Option<Lock>,
}

impl WorkFolder {
    /// Creates a folder in `parent` and removes those of ended processes.
    pub(crate) fn new(parent: &Path, progress: &dyn Progress) -> Result<Self> {
        // The lock excludes a sweep between creating the folder and locking it.
        let _turn = Lock::acquire(&parent.join("sweep.lock"), "a work folder", progress)?;
        sweep(parent).context(|| parent.display().to_string())?;
        let mut number = 0;
        loop {
            let path = parent.join(format!("{}-{number}", std::process::id()));
            match fs::create_dir(&path) {
                Ok(()) => {
                    let lock = Lock::try_acquire(&lock_path(&path));
                    return Ok(Self { path, lock });
                }
                // Another process with the same id, in another container on the same disk.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists && number < 10_000 => number += 1,
                Err(error) => return Err(error).context(|| path.display().to_string()),
            }
        }
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Creates a folder in it.
    pub(crate) fn folder(&self, name: &str) -> Result<PathBuf> {
        let path = self.path.join(name);
        fs::create_dir_all(&path).context(|| path.display().to_string())?;
        Ok(path)
    }
}

impl Drop for WorkFolder {
    fn drop(&mut self) {
        // A folder that cannot be removed now is swept later.
        if fs::remove_dir_all(&self.path).is_ok() {
            drop(self.lock.take());
            let _ = fs::remove_file(lock_path(&self.path));
        }
    }
}

fn lock_path(folder: &Path) -> PathBuf {
    folder.with_extension("lock")
}

fn sweep(parent: &Path) -> io::Result<()> {
    for entry in fs::read_dir(parent)? {
        let path = entry?.path();
        if path.is_dir() && Lock::try_acquire(&lock_path(&path)).is_some() {
            // A package client that outlived its parent may still be writing; the next sweep removes the folder.
            let _ = fs::remove_dir_all(&path);
            let _ = fs::remove_file(lock_path(&path));
        }
    }
    Ok(())
}
