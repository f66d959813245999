//! File locks between processes.

use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant, SystemTime};

use opendr_engine::{Error, Result};

/// Time without changes to the file after which a lock is broken, as its holder must have been killed; the same as Optuna's.
const GRACE: Duration = Duration::from_secs(30);
const MAX_WAIT: Duration = Duration::from_millis(200);

static COUNTER: AtomicU64 = AtomicU64::new(0);

/// Holds the lock of a file until dropped: a symbolic link beside it, like Optuna's `JournalFileSymlinkLock`, or
/// without symbolic links a new file, like its `JournalFileOpenLock`. Both respect each other.
#[derive(Debug)]
pub struct Lock {
    path: PathBuf,
}

impl Lock {
    /// Waits for the lock of `file`, an absolute path.
    pub fn acquire(file: &Path) -> Result<Self> {
        let mut path = file.as_os_str().to_owned();
        path.push(".lock");
        let path = PathBuf::from(path);
        let mut wait = Duration::from_millis(1);
        let mut unchanged = (last_change(file), Instant::now());
        loop {
            match create(file, &path) {
                Ok(()) => return Ok(Self { path }),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => {
                    let what = format!("cannot lock {}; use a writable folder", file.display());
                    return Err(Error::io(what).with_source(error));
                }
            }
            let changed = last_change(file);
            if changed != unchanged.0 {
                unchanged = (changed, Instant::now());
            } else if unchanged.1.elapsed() > GRACE {
                remove(&path);
                unchanged.1 = Instant::now();
            }
            thread::sleep(wait);
            wait = MAX_WAIT.min(wait * 2);
        }
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        remove(&self.path);
    }
}

fn last_change(file: &Path) -> Option<(SystemTime, u64)> {
    let facts = fs::metadata(file).ok()?;
    Some((facts.modified().ok()?, facts.len()))
}

/// Renames the lock before removal, so that only one of two processes removes it.
fn remove(lock: &Path) {
    let mut name = OsString::from(lock.as_os_str());
    name.push(format!("{}-{}.rename", std::process::id(), COUNTER.fetch_add(1, Ordering::Relaxed)));
    if fs::rename(lock, &name).is_ok() {
        fs::remove_file(&name).ok();
    }
}

#[cfg(unix)]
fn create(file: &Path, lock: &Path) -> io::Result<()> {
    std::os::unix::fs::symlink(file, lock)
}

#[cfg(not(unix))]
fn create(_file: &Path, lock: &Path) -> io::Result<()> {
    fs::OpenOptions::new().write(true).create_new(true).open(lock).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_holder_at_a_time() {
        let folder = std::env::temp_dir().join(format!("opendr-lock-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let file = folder.join("study.log");
        fs::write(&file, "0").unwrap();
        thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..50 {
                        let lock = Lock::acquire(&file).unwrap();
                        let count: u64 = fs::read_to_string(&file).unwrap().parse().unwrap();
                        fs::write(&file, (count + 1).to_string()).unwrap();
                        drop(lock);
                    }
                });
            }
        });
        assert_eq!(fs::read_to_string(&file).unwrap(), "200");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "locks are left");
        fs::remove_dir_all(folder).unwrap();
        assert_eq!(
            Lock::acquire(Path::new("/no/such/study.log")).unwrap_err().kind(),
            opendr_engine::ErrorKind::Io
        );
    }
}
