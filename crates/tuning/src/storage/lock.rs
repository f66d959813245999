//! One writer at a time, between processes.

use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant, SystemTime};

use opendr_engine::{Error, Result};

/// A lock is broken when the file has not changed for so long: its holder was killed. Optuna waits as long.
const GRACE: Duration = Duration::from_secs(30);
const LONGEST_WAIT: Duration = Duration::from_millis(200);

static COUNTER: AtomicU64 = AtomicU64::new(0);

/// The lock of a file while this lives: a symbolic link beside it, as Optuna's `JournalFileSymlinkLock` makes it, and
/// where there are none a new file, as its `JournalFileOpenLock`. Each respects the other.
#[derive(Debug)]
pub struct Lock {
    path: PathBuf,
}

impl Lock {
    /// Waits until nobody else holds the lock of `file`, an absolute path.
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
                    let what = format!("cannot lock {}: name a folder that may be written", file.display());
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
            wait = LONGEST_WAIT.min(wait * 2);
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

/// By another name first, so that of two who remove it one only does.
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
