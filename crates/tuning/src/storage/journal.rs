//! Optuna's journal: a file with one operation per line, to which every worker appends.

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result, ResultExt};

use crate::storage::lock::Lock;
use crate::storage::operation::Operation;
use crate::storage::python_json::{text_from_value, value_from_text};

/// Maximum length of a line, against files without line ends.
const MAX_LINE_BYTES: u64 = 64 << 20;

/// A journal file and the position up to which it has been read.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    read: Position,
}

#[derive(Debug, Clone, Copy, Default)]
struct Position {
    byte: u64,
    line: u64,
}

impl Journal {
    /// Opens the journal at `path`; creates it if missing.
    pub fn open(path: &Path) -> Result<Self> {
        let what = || format!("opening the journal {}", path.display());
        let path = std::path::absolute(path).context(what)?;
        OpenOptions::new().create(true).append(true).open(&path).context(what)?;
        Ok(Self { path, read: Position::default() })
    }

    pub fn lock(&self) -> Result<Lock> {
        Lock::acquire(&self.path)
    }

    /// Passes the operations appended since the last call, with their workers, to `apply`.
    pub fn read_new(&mut self, apply: impl FnMut(Operation, &str)) -> Result<()> {
        let reading = || format!("reading the journal {}", self.path.display());
        let mut file = File::open(&self.path).context(reading)?;
        if file.metadata().context(reading)?.len() < self.read.byte {
            return Err(Error::integrity(
                "the file was truncated or replaced while in use; open the study again",
            )
            .context(reading()));
        }
        file.seek(SeekFrom::Start(self.read.byte)).context(reading)?;
        read_lines(&mut BufReader::new(file), &mut self.read, apply)
            .context(|| format!("reading the journal {}", self.path.display()))
    }

    /// Appends operations and syncs the file. First, an incomplete last line of a killed writer is cut off, which no reader has
    /// processed.
    pub fn append(&self, _held: &Lock, operations: &[Operation], worker: &str) -> Result<()> {
        let mut text = String::new();
        for operation in operations {
            text.push_str(&text_from_value(&operation.to_json(worker)));
            text.push('\n');
        }
        let write = || {
            let mut file = OpenOptions::new().read(true).append(true).open(&self.path)?;
            let length = file.metadata()?.len();
            let whole = whole_lines(&mut file, length)?;
            if whole < length {
                file.set_len(whole)?;
            }
            file.write_all(text.as_bytes())?;
            file.sync_data()
        };
        write().context(|| format!("writing the journal {}", self.path.display()))
    }
}

/// Passes the operations in `bytes` to `apply`.
pub fn read_text(bytes: &[u8], apply: impl FnMut(Operation, &str)) -> Result<()> {
    read_lines(&mut &bytes[..], &mut Position::default(), apply)
}

/// Skips a last line without a line end: it is being written, or its writer was killed.
fn read_lines(
    reader: &mut impl BufRead,
    at: &mut Position,
    mut apply: impl FnMut(Operation, &str),
) -> Result<()> {
    let mut line = Vec::new();
    loop {
        line.clear();
        let length = reader.by_ref().take(MAX_LINE_BYTES).read_until(b'\n', &mut line)? as u64;
        if line.last() != Some(&b'\n') {
            if length == MAX_LINE_BYTES {
                return Err(Error::format(format!(
                    "line {} is longer than {MAX_LINE_BYTES} bytes",
                    at.line + 1
                )));
            }
            return Ok(());
        }
        let (operation, worker) = operation_from_line(&line).map_err(|error| {
            error.context(format!("line {} is damaged, or the file is not a journal of Optuna", at.line + 1))
        })?;
        apply(operation, &worker);
        at.byte += length;
        at.line += 1;
    }
}

fn operation_from_line(line: &[u8]) -> Result<(Operation, String)> {
    let text = std::str::from_utf8(line)
        .map_err(|error| Error::format("the line is not UTF-8").with_source(error))?;
    Operation::from_json(&value_from_text(text)?)
}

/// Returns the length of the file up to the end of its last complete line.
fn whole_lines(file: &mut File, length: u64) -> std::io::Result<u64> {
    let mut end = length;
    let mut block = [0; 4096];
    while end > 0 {
        let start = end.saturating_sub(block.len() as u64);
        let part = &mut block[..(end - start) as usize];
        file.seek(SeekFrom::Start(start))?;
        file.read_exact(part)?;
        if let Some(at) = part.iter().rposition(|byte| *byte == b'\n') {
            return Ok(start + at as u64 + 1);
        }
        end = start;
    }
    Ok(0)
}
