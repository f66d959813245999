//! The journal: a file with one operation a line, to which every worker appends.

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result, ResultExt};

use crate::storage::lock::Lock;
use crate::storage::operation::Operation;
use crate::storage::python_json::{text_from_value, value_from_text};

/// No line of ours comes near; one without end would fill the memory.
const LONGEST_LINE: u64 = 64 << 20;

/// Where a journal stands, and how far it was read.
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
    /// The journal at `path`, made when there is none.
    pub fn open(path: &Path) -> Result<Self> {
        let what = || format!("opening the journal {}", path.display());
        let path = std::path::absolute(path).context(what)?;
        OpenOptions::new().create(true).append(true).open(&path).context(what)?;
        Ok(Self { path, read: Position::default() })
    }

    pub fn lock(&self) -> Result<Lock> {
        Lock::acquire(&self.path)
    }

    /// Hands over what was appended since the last time, by whom.
    pub fn read_new(&mut self, apply: impl FnMut(Operation, &str)) -> Result<()> {
        let reading = || format!("reading the journal {}", self.path.display());
        let mut file = File::open(&self.path).context(reading)?;
        if file.metadata().context(reading)?.len() < self.read.byte {
            return Err(Error::integrity("it was cut or replaced while it was in use; open the study again")
                .context(reading()));
        }
        file.seek(SeekFrom::Start(self.read.byte)).context(reading)?;
        read_lines(&mut BufReader::new(file), &mut self.read, apply)
            .context(|| format!("reading the journal {}", self.path.display()))
    }

    /// Appends and brings to the disk. What a writer that was killed left of its last line is cut off first: no reader has
    /// taken it for a line.
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

/// Hands over the operations of `bytes`.
pub fn read_text(bytes: &[u8], apply: impl FnMut(Operation, &str)) -> Result<()> {
    read_lines(&mut &bytes[..], &mut Position::default(), apply)
}

/// A last line without an end is being written, or was when its writer was killed: it is left out.
fn read_lines(
    reader: &mut impl BufRead,
    at: &mut Position,
    mut apply: impl FnMut(Operation, &str),
) -> Result<()> {
    let mut line = Vec::new();
    loop {
        line.clear();
        let length = reader.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line)? as u64;
        if line.last() != Some(&b'\n') {
            if length == LONGEST_LINE {
                return Err(Error::format(format!(
                    "line {} is longer than {LONGEST_LINE} bytes",
                    at.line + 1
                )));
            }
            return Ok(());
        }
        let (operation, worker) = operation_from_line(&line).map_err(|error| {
            error.context(format!("line {}: damaged, or no journal of a study", at.line + 1))
        })?;
        apply(operation, &worker);
        at.byte += length;
        at.line += 1;
    }
}

fn operation_from_line(line: &[u8]) -> Result<(Operation, String)> {
    let text = std::str::from_utf8(line).map_err(|error| Error::format("no UTF-8").with_source(error))?;
    Operation::from_json(&value_from_text(text)?)
}

/// The length of the file up to the end of its last whole line.
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
