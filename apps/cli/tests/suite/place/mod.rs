//! A folder and a cache of its own for each test, and the built command run in it.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command};
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread;
use std::time::Duration;

use serde_json::Value;

/// A new empty folder, removed at the end of the test.
pub struct Place(pub PathBuf);

impl Drop for Place {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Result of a command.
#[derive(Debug)]
pub struct Done {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
    /// Peak resident memory in 10^6 bytes; 0 where it is unknown.
    pub peak_mb: f64,
}

impl Done {
    /// Returns the lines of standard output as JSON.
    pub fn lines(&self) -> Vec<Value> {
        self.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }

    /// Fails the test unless the run ended with `code` and without a panic.
    #[track_caller]
    pub fn ends_with(self, code: i32) -> Self {
        assert!(self.code == code && !self.stderr.contains("panicked"), "expected {code}: {self:#?}");
        self
    }
}

fn test_data() -> Option<PathBuf> {
    std::env::var_os("OPENDR_TEST_DATA").map(PathBuf::from)
}

impl Place {
    pub fn new() -> Self {
        static COUNTER: AtomicU32 = AtomicU32::new(0);
        let count = COUNTER.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("opendr-cli-{}-{count}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// Returns a place and the folder with real models and data; prints a line and returns `None` without `OPENDR_TEST_DATA`.
    pub fn with_data() -> Option<(Self, PathBuf)> {
        let data = test_data();
        if data.is_none() {
            println!("skipped: no OPENDR_TEST_DATA");
        }
        Some((Self::new(), data?))
    }

    /// Returns the command in this place, with its cache and without network; models come from the test data.
    pub fn command(&self, arguments: impl IntoIterator<Item = impl AsRef<OsStr>>) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_opendr"));
        command
            .args(arguments)
            .current_dir(&self.0)
            .env("OPENDR_CACHE", self.0.join("cache"))
            .env("OPENDR_MODEL_REPOSITORY", test_data().unwrap_or_default().join("models"))
            .env("OPENDR_OFFLINE", "1")
            .env_remove("OPENDR_DEVICE");
        command
    }

    /// Runs the command to its end.
    pub fn run(&self, arguments: impl IntoIterator<Item = impl AsRef<OsStr>>) -> Done {
        self.start(self.command(arguments)).finish()
    }

    /// Starts a command.
    pub fn start(&self, mut command: Command) -> Running {
        static COUNTER: AtomicU32 = AtomicU32::new(0);
        let count = COUNTER.fetch_add(1, Ordering::Relaxed);
        let outputs = ["stdout", "stderr"].map(|name| self.0.join(format!(".{name}-{count}")));
        let [stdout, stderr] = outputs.each_ref().map(|path| File::create(path).unwrap());
        let child = command.stdout(stdout).stderr(stderr).spawn().unwrap();
        Running { child, outputs }
    }

    pub fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.0.join(name)
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, bytes).unwrap();
        path
    }
}

/// A running command.
pub struct Running {
    pub child: Child,
    outputs: [PathBuf; 2],
}

impl Running {
    /// Returns the standard output so far.
    pub fn stdout(&self) -> String {
        String::from_utf8_lossy(&fs::read(&self.outputs[0]).unwrap()).into_owned()
    }

    /// Waits for the end and measures the memory meanwhile.
    pub fn finish(mut self) -> Done {
        let mut peak_mb = 0.0;
        let status = loop {
            peak_mb = peak_of(self.child.id()).unwrap_or(peak_mb);
            match self.child.try_wait().unwrap() {
                Some(status) => break status,
                None => thread::sleep(Duration::from_millis(2)),
            }
        };
        let [stdout, stderr] = self
            .outputs
            .each_ref()
            .map(|path| String::from_utf8_lossy(&fs::read(path).unwrap()).into_owned());
        Done { code: status.code().unwrap_or(-1), stdout, stderr, peak_mb }
    }
}

fn peak_of(process: u32) -> Option<f64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()? * 1024.0 / 1e6)
}
