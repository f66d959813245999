//! The log of a run.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use opendr_engine::data::Image;
use opendr_engine::{Error, Result};

use crate::atomic_file::{write_atomically, write_error};
use crate::curves::svg_from_table;
use crate::earlier_run;
use crate::event::{Content, Picture, SummaryValue};
use crate::event_file::EventFile;
use crate::file_names::{CURVES, TABLE};
use crate::scalar_table::ScalarTable;

/// Maximum time before logged values are written to the disk, checked when more are logged.
const WRITE_INTERVAL: Duration = Duration::from_secs(5);

const MAX_TAG_BYTES: usize = 500;

/// The log of a run, in a folder: event files for TensorBoard, `log.csv` with a row per step and a column per tag, and
/// `curves.svg` with the loss (`loss...`) and the validation metrics (`val_...`).
///
/// A kill loses the values of the last seconds. Call [`RunLog::flush`] before saving a checkpoint, so that a run that resumes from
/// it finds every row. Dropping a log flushes it.
///
/// ```
/// # fn main() -> opendr_engine::Result<()> {
/// # let folder = std::env::temp_dir().join(format!("opendr-run-log-{}", std::process::id()));
/// let mut log = opendr_runlog::RunLog::open(Some(&folder), None)?;
/// log.scalar("loss", 1, 0.7)?;
/// log.scalar("loss", 2, 0.6)?;
/// log.scalar("val_map50", 2, 0.3)?;
/// log.flush()?;
/// assert_eq!(std::fs::read_to_string(folder.join("log.csv"))?, "step,loss,val_map50\n1,0.7,\n2,0.6,0.3\n");
/// # std::fs::remove_dir_all(folder)?;
/// # Ok(()) }
/// ```
#[derive(Debug)]
pub struct RunLog {
    files: Option<Files>,
}

#[derive(Debug)]
struct Files {
    folder: PathBuf,
    events: EventFile,
    table: ScalarTable,
    written: Instant,
}

impl RunLog {
    /// Opens the log in `folder`, which is created if missing; without a folder, the log writes nothing.
    ///
    /// A new run archives the log of an earlier one in the subfolder `earlier-1`, `earlier-2`, ...
    /// A run that resumes from a step continues the log; rows of later steps are dropped, and readers discard their
    /// events.
    ///
    /// # Errors
    /// `Io` when the folder cannot be written, `Format` when the table to continue is invalid.
    pub fn open(folder: Option<&Path>, resume_from: Option<u64>) -> Result<Self> {
        let Some(folder) = folder else { return Ok(Self { files: None }) };
        fs::create_dir_all(folder).map_err(|error| write_error(folder, error))?;
        let path = folder.join(TABLE);
        let (table, first_step) = match resume_from {
            Some(step) => (ScalarTable::read(path, step)?, step.saturating_add(1)),
            None => {
                earlier_run::set_aside(folder)?;
                (ScalarTable::new(path), 0)
            }
        };
        let events = EventFile::create(folder, first_step)?;
        Ok(Self { files: Some(Files { folder: folder.to_owned(), events, table, written: Instant::now() }) })
    }

    /// Logs a number of a step.
    ///
    /// # Errors
    /// `InvalidParam` for a tag that is empty, too long or has control characters; `Io` when the disk is full. Logged
    /// values are kept and written by a later call that succeeds.
    pub fn scalar(&mut self, tag: &str, step: u64, value: f64) -> Result<()> {
        let Some(files) = checked(tag, &mut self.files)? else { return Ok(()) };
        files.table.set(tag, step, value);
        files.events.summary(step, summary_value(tag, Content::Scalar(value as f32)))?;
        files.write_when_due()
    }

    /// Logs an image of a step, in the event file.
    ///
    /// # Errors
    /// `InvalidInput` when the image is empty or too large for a PNG file; else as [`RunLog::scalar`].
    pub fn image(&mut self, tag: &str, step: u64, image: &Image) -> Result<()> {
        let Some(files) = checked(tag, &mut self.files)? else { return Ok(()) };
        let side = |pixels: usize| i32::try_from(pixels).unwrap_or(i32::MAX);
        let picture = Picture {
            height: side(image.height()),
            width: side(image.width()),
            colorspace: side(image.format().channels()),
            encoded: opendr_vision::encode_png(image)?,
        };
        files.events.summary(step, summary_value(tag, Content::Picture(picture)))?;
        files.write_when_due()
    }

    /// Writes all logged values to the disk.
    ///
    /// # Errors
    /// `Io` when the disk is full.
    pub fn flush(&mut self) -> Result<()> {
        self.files.as_mut().map_or(Ok(()), |files| files.write(true))
    }
}

impl Drop for RunLog {
    fn drop(&mut self) {
        // An error can be obtained only by a call of `flush`.
        self.flush().ok();
    }
}

impl Files {
    fn write_when_due(&mut self) -> Result<()> {
        if self.written.elapsed() < WRITE_INTERVAL { Ok(()) } else { self.write(false) }
    }

    fn write(&mut self, whole: bool) -> Result<()> {
        self.written = Instant::now();
        self.events.flush()?;
        self.table.write(whole)?;
        match svg_from_table(&self.table) {
            Some(svg) => write_atomically(&self.folder.join(CURVES), svg.as_bytes()),
            None => Ok(()),
        }
    }
}

fn summary_value(tag: &str, content: Content) -> SummaryValue {
    SummaryValue { tag: tag.to_owned(), content: Some(content) }
}

fn checked<'a, T>(tag: &str, files: &'a mut Option<T>) -> Result<Option<&'a mut T>> {
    if tag.is_empty() || tag.len() > MAX_TAG_BYTES || tag.contains(char::is_control) {
        let shown: String = tag.chars().take(40).collect();
        return Err(Error::invalid_param(format!(
            "the tag {shown:?} is invalid; use 1 to {MAX_TAG_BYTES} bytes without control characters"
        )));
    }
    Ok(files.as_mut())
}
