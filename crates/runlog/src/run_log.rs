//! The log of a run.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use opendr_engine::data::Image;
use opendr_engine::{Error, Result};

use crate::atomic_file::{refused, write_atomically};
use crate::curves::svg_from_table;
use crate::earlier_run;
use crate::event::{Content, Picture, SummaryValue};
use crate::event_file::EventFile;
use crate::scalar_table::ScalarTable;

pub(crate) const TABLE: &str = "log.csv";
pub(crate) const CURVES: &str = "curves.svg";

/// What is told is on the disk after this time at the latest, once more is told.
const EVERY: Duration = Duration::from_secs(5);

const LONGEST_TAG: usize = 500;

/// The log of a run, in a folder: event files for TensorBoard, `log.csv` with a row a step and a column a tag, and
/// `curves.svg` with the loss (`loss...`) and the numbers of the validation (`val_...`).
///
/// A kill loses what was told in the last seconds; [`RunLog::flush`] before a checkpoint, so that a run that resumes from
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
    /// Opens the log in `folder`, which is made where it is not there; without a folder, the log writes nothing.
    ///
    /// A run that begins anew finds room: the log of an earlier one is moved into `earlier-1`, `earlier-2`, ... in there.
    /// One that resumes from a step goes on with the log; of later steps, rows are dropped, and events too in the eyes of
    /// every reader.
    ///
    /// # Errors
    /// `Io` when the folder cannot be written, `Format` when the table to go on with is none.
    pub fn open(folder: Option<&Path>, resume_from: Option<u64>) -> Result<Self> {
        let Some(folder) = folder else { return Ok(Self { files: None }) };
        fs::create_dir_all(folder).map_err(|error| refused(folder, error))?;
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

    /// Tells a number of a step.
    ///
    /// # Errors
    /// `InvalidParam` for a tag that is empty, too long or has control characters; `Io` when the disk is full: what was
    /// told is kept, and written by a later call that can.
    pub fn scalar(&mut self, tag: &str, step: u64, value: f64) -> Result<()> {
        let Some(files) = checked(tag, &mut self.files)? else { return Ok(()) };
        files.table.set(tag, step, value);
        files.events.summary(step, summary_value(tag, Content::Scalar(value as f32)))?;
        files.write_when_due()
    }

    /// Shows a picture of a step, in the event file.
    ///
    /// # Errors
    /// `InvalidInput` when the picture is empty or too large for a PNG file; else as [`RunLog::scalar`].
    pub fn picture(&mut self, tag: &str, step: u64, image: &Image) -> Result<()> {
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

    /// Brings everything told to the disk, now.
    ///
    /// # Errors
    /// `Io` when the disk is full.
    pub fn flush(&mut self) -> Result<()> {
        self.files.as_mut().map_or(Ok(()), |files| files.write(true))
    }
}

impl Drop for RunLog {
    fn drop(&mut self) {
        // Who wants to know calls `flush`.
        self.flush().ok();
    }
}

impl Files {
    fn write_when_due(&mut self) -> Result<()> {
        if self.written.elapsed() < EVERY { Ok(()) } else { self.write(false) }
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
    if tag.is_empty() || tag.len() > LONGEST_TAG || tag.contains(char::is_control) {
        let shown: String = tag.chars().take(40).collect();
        return Err(Error::invalid_param(format!(
            "the tag {shown:?} does not fit: 1 to {LONGEST_TAG} bytes without control characters do"
        )));
    }
    Ok(files.as_mut())
}
