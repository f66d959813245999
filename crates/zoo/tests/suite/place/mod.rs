//! A cache of its own for each test, and cards made for it.

use std::fs;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};
use std::time::Duration;

use opendr_engine::model::Sha256;
use opendr_engine::{Progress, Unit};
use opendr_zoo::{Card, Zoo, ZooOptions};

/// A new empty folder, removed at the end of the test.
pub struct Place(pub PathBuf);

impl Drop for Place {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

impl Place {
    pub fn new() -> Self {
        static COUNTER: AtomicU32 = AtomicU32::new(0);
        let count = COUNTER.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("opendr-zoo-{}-{count}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub fn options(&self) -> ZooOptions {
        let mut options = ZooOptions::new(self.0.join("cache"));
        options.timeout = Duration::from_millis(500);
        options.retry_pause = Duration::from_millis(1);
        options
    }

    pub fn zoo(&self, card: &str) -> Zoo {
        Zoo::with_cards(self.options(), vec![Card::from_toml(card).unwrap()])
    }

    /// Files in a folder of the cache.
    pub fn files(&self, folder: &str) -> Vec<PathBuf> {
        let Ok(entries) = fs::read_dir(self.0.join("cache").join(folder)) else { return Vec::new() };
        entries.map(|entry| entry.unwrap().path()).collect()
    }
}

/// Returns `count` incompressible bytes.
pub fn noise(count: usize) -> Vec<u8> {
    let mut state = 1u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    (0..count).map(|_| next()).collect()
}

/// Returns a card `test/one` of one file `model.onnx`, with this TOML as its sources.
pub fn card(bytes: &[u8], sources: &str) -> String {
    format!(
        r#"
learner = "test"
task = "face_detection"
description = "For a test."
[[variants]]
name = "one"
default = true
licence = {{}}
files = [{{ name = "model.onnx", size = {}, sha256 = "{}" }}]
{sources}
"#,
        bytes.len(),
        Sha256::of(bytes)
    )
}

/// Returns a source at an address.
pub fn url(address: &str) -> String {
    format!("[[variants.sources]]\nkind = \"url\"\nfiles = {{ \"model.onnx\" = \"{address}\" }}\n")
}

/// Records the progress calls.
#[derive(Default)]
pub struct Record {
    pub total: AtomicU64,
    pub done: AtomicU64,
    pub notes: Mutex<Vec<String>>,
    pub stop: AtomicBool,
}

impl Progress for Record {
    fn begin(&self, _: &str, total: Option<u64>, _: Unit) {
        self.total.fetch_add(total.unwrap_or(0), Ordering::Relaxed);
    }

    fn advance(&self, amount: u64) {
        self.done.fetch_add(amount, Ordering::Relaxed);
    }

    fn end(&self) {}

    fn note(&self, line: &str) {
        self.notes.lock().unwrap().push(line.to_owned());
    }

    fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}
