//! Folders for unfinished work, which vanish with it.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use opendr_engine::{Progress, Result, ResultExt};

use crate::lock::Lock;

/// A new folder, removed when dropped; when the process is killed, the next one that makes a work folder removes it.
#[derive(Debug)]
pub(crate) struct WorkFolder {
    path: PathBuf,
    lock: Option<Lock>,
}

impl WorkFolder {
    /// Makes a folder in `parent` and removes those there whose owners are dead.
    pub(crate) fn new(parent: &Path, progress: &dyn Progress) -> Result<Self> {
        // Nobody sweeps between the making of a folder and the locking of it.
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
                // Another process with the same number, in another container on the same disk.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists && number < 10_000 => number += 1,
                Err(error) => return Err(error).context(|| path.display().to_string()),
            }
        }
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// A new folder in it.
    pub(crate) fn folder(&self, name: &str) -> Result<PathBuf> {
        let path = self.path.join(name);
        fs::create_dir_all(&path).context(|| path.display().to_string())?;
        Ok(path)
    }
}

impl Drop for WorkFolder {
    fn drop(&mut self) {
        // What cannot be removed now is swept later.
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
            // A package client that outlived its parent may still be writing: then the next sweep gets it.
            let _ = fs::remove_dir_all(&path);
            let _ = fs::remove_file(lock_path(&path));
        }
    }
    Ok(())
}
