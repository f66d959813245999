//! Event files: TensorFlow records, each an [`IterationEvent`].

use std::fs::{self, File, OpenOptions};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use opendr_engine::Result;
use prost::Message;

use crate::atomic_file::write_error;
use crate::crc32c::masked_crc32c;
use crate::event::{Event, SessionLog, SessionStatus, Summary, SummaryValue, What};

const PREFIX: &str = "events.out.tfevents.";

/// Maximum bytes of buffered records.
const MAX_BUFFERED: usize = 4 << 20;

/// An event file being written. It contains complete records only, even if the disk becomes full.
#[derive(Debug)]
pub struct EventFile {
    path: PathBuf,
    file: File,
    /// Bytes of complete records in the file.
    length: u64,
    waiting: Vec<u8>,
}

impl EventFile {
    /// Creates a file in `folder`, which readers process after all existing ones; from `first_step` on it replaces their
    /// events.
    pub fn create(folder: &Path, first_step: u64) -> Result<Self> {
        let (path, file) = new_file(folder).map_err(|error| write_error(folder, error))?;
        let mut events = Self { path, file, length: 0, waiting: Vec::new() };
        events.add(0, What::FileVersion("brain.Event:2".to_owned()))?;
        events.add(first_step, What::SessionLog(SessionLog { status: SessionStatus::Start.into() }))?;
        events.flush()?;
        Ok(events)
    }

    /// Adds a value of `step`.
    pub fn summary(&mut self, step: u64, value: SummaryValue) -> Result<()> {
        self.add(step, What::Summary(Summary { value: vec![value] }))
    }

    fn add(&mut self, step: u64, what: What) -> Result<()> {
        let wall_time = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs_f64();
        let event = Event { wall_time, step: step.try_into().unwrap_or(i64::MAX), what: Some(what) };
        let bytes = event.encode_to_vec();
        let length = (bytes.len() as u64).to_le_bytes();
        self.waiting.extend(length);
        self.waiting.extend(masked_crc32c(&length).to_le_bytes());
        self.waiting.extend(&bytes);
        self.waiting.extend(masked_crc32c(&bytes).to_le_bytes());
        if self.waiting.len() > MAX_BUFFERED { self.flush() } else { Ok(()) }
    }

    /// Writes all buffered records to the disk. On failure the file is truncated to complete records, and the others stay buffered.
    pub fn flush(&mut self) -> Result<()> {
        if self.waiting.is_empty() {
            return Ok(());
        }
        let written = self.file.write_all(&self.waiting).and_then(|()| self.file.sync_data());
        if let Err(error) = written {
            let cut = self.file.set_len(self.length);
            cut.and_then(|()| self.file.seek(SeekFrom::Start(self.length))).ok();
            return Err(write_error(&self.path, error));
        }
        self.length += self.waiting.len() as u64;
        self.waiting.clear();
        Ok(())
    }
}

/// Returns whether a file name is that of an event file.
pub fn is_event_file(name: &str) -> bool {
    name.starts_with(PREFIX)
}

// Readers process files in order of their names, so the time in the name must be later than all others, whatever the
// clock says.
fn new_file(folder: &Path) -> io::Result<(PathBuf, File)> {
    let mut time = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs();
    for entry in fs::read_dir(folder)? {
        let name = entry?.file_name();
        let rest = name.to_str().and_then(|name| name.strip_prefix(PREFIX)).unwrap_or_default();
        let taken: Option<u64> = rest.split('.').next().and_then(|digits| digits.parse().ok());
        time = time.max(taken.map_or(0, |taken| taken.saturating_add(1)));
    }
    let path = folder.join(format!("{PREFIX}{time:010}.opendr.{}", std::process::id()));
    let file = OpenOptions::new().write(true).create_new(true).open(&path)?;
    Ok((path, file))
}
