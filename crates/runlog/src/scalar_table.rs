//! The table of a run's scalars: a row per step, a column per tag.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{self, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result, ResultExt};

use crate::atomic_file::{write_atomically, write_error};
use crate::csv;
use crate::file_names::TABLE;

/// Maximum size of a table that is read.
const MAX_BYTES: u64 = 1 << 30;

/// Returns whether `folder` has a log's table of scalars.
pub fn has_scalars(folder: &Path) -> bool {
    folder.join(TABLE).is_file()
}

/// Reads the scalars of a log in `folder`, written up to now: `[step, value]` pairs by tag, empty if there is no log.
///
/// # Errors
/// `Format` with the number of an invalid line, `Io` when the table cannot be read.
pub fn read_scalars(folder: &Path) -> Result<Vec<(String, Vec<[f64; 2]>)>> {
    let table = ScalarTable::read(folder.join(TABLE), u64::MAX)?;
    Ok(table.tags().map(|tag| (tag.to_owned(), table.points(tag))).collect())
}

/// A table in memory and its CSV file.
#[derive(Debug)]
pub struct ScalarTable {
    path: PathBuf,
    tags: Vec<String>,
    /// Rows by step; a row may be shorter than the number of columns.
    rows: BTreeMap<u64, Vec<Option<f64>>>,
    /// Newest step in the file.
    newest_written: Option<u64>,
    /// Whether the file differs from the table up to that step.
    is_stale: bool,
}

impl ScalarTable {
    /// Creates an empty table that will replace the file at `path`.
    pub fn new(path: PathBuf) -> Self {
        Self { path, tags: Vec::new(), rows: BTreeMap::new(), newest_written: None, is_stale: true }
    }

    /// Reads the table at `path` up to `last_step`; an empty one if there is no file. An incomplete last line of a killed
    /// process is dropped.
    ///
    /// # Errors
    /// `Format` with the number of the invalid line.
    pub fn read(path: PathBuf, last_step: u64) -> Result<Self> {
        let mut table = Self::new(path);
        let context = |path: &Path| format!("reading {}", path.display());
        let size = match fs::metadata(&table.path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(table),
            found => found.context(|| context(&table.path))?.len(),
        };
        if size > MAX_BYTES {
            let path = table.path.display();
            return Err(Error::format(format!(
                "{path} has {size} bytes, more than the limit of {MAX_BYTES}"
            )));
        }
        let bytes = fs::read(&table.path).context(|| context(&table.path))?;
        let text = String::from_utf8_lossy(&bytes);
        let whole = text.rsplit_once('\n').map_or("", |(whole, _)| whole);
        for (at, line) in whole.lines().enumerate() {
            table.read_line(at, line, last_step).ok_or_else(|| {
                let (path, line) = (table.path.display(), at + 1);
                Error::format(format!(
                    "{path}, line {line} is not a row of the table; move the file away to continue"
                ))
            })?;
        }
        Ok(table)
    }

    fn read_line(&mut self, at: usize, line: &str, last_step: u64) -> Option<()> {
        let mut values = csv::values(line)?.into_iter();
        let first = values.next()?;
        if at == 0 {
            self.tags = values.collect();
            return (first == "step").then_some(());
        }
        let step: u64 = first.parse().ok()?;
        let row = values
            .map(|value| if value.is_empty() { Some(None) } else { value.parse().ok().map(Some) })
            .collect::<Option<Vec<Option<f64>>>>()?;
        if row.len() != self.tags.len() {
            return None;
        }
        if step <= last_step {
            self.rows.insert(step, row);
        }
        Some(())
    }

    /// Sets the value of `tag` at `step`.
    pub fn set(&mut self, tag: &str, step: u64, value: f64) {
        let column = self.tags.iter().position(|known| known == tag).unwrap_or_else(|| {
            self.tags.push(tag.to_owned());
            self.is_stale = true;
            self.tags.len() - 1
        });
        let row = self.rows.entry(step).or_default();
        if row.len() <= column {
            row.resize(column + 1, None);
        }
        if let Some(cell) = row.get_mut(column) {
            *cell = Some(value);
        }
        self.is_stale |= self.newest_written.is_some_and(|written| step <= written);
    }

    /// Returns the tags, in order of the columns.
    pub fn tags(&self) -> impl Iterator<Item = &str> {
        self.tags.iter().map(String::as_str)
    }

    /// Returns `[step, value]` pairs of a tag.
    pub fn points(&self, tag: &str) -> Vec<[f64; 2]> {
        let column = self.tags.iter().position(|known| known == tag).unwrap_or(usize::MAX);
        let value = |row: &Vec<Option<f64>>| row.get(column).copied().flatten();
        self.rows.iter().filter_map(|(step, row)| Some([*step as f64, value(row)?])).collect()
    }

    /// Writes the table to the disk. The newest row is written only if `whole`, since more values of its step may follow.
    ///
    /// # Errors
    /// `Io` when the disk is full; the file then ends in a complete row, and the next call writes the rest.
    pub fn write(&mut self, whole: bool) -> Result<()> {
        let Some((&newest, _)) = self.rows.last_key_value() else { return Ok(()) };
        let end = if whole { newest.saturating_add(1) } else { newest };
        if self.is_stale {
            let heading =
                ["step"].into_iter().chain(self.tags()).map(csv::quoted).collect::<Vec<_>>().join(",");
            let text = format!("{heading}\n{}", self.lines(0, end));
            write_atomically(&self.path, text.as_bytes())?;
        } else {
            let begin = self.newest_written.map_or(0, |written| written.saturating_add(1));
            let lines = self.lines(begin, end);
            append(&self.path, lines.as_bytes()).map_err(|error| write_error(&self.path, error))?;
        }
        self.is_stale = false;
        self.newest_written = self.rows.range(..end).next_back().map(|(step, _)| *step);
        Ok(())
    }

    fn lines(&self, begin: u64, end: u64) -> String {
        let mut text = String::new();
        for (step, row) in self.rows.range(begin..end.max(begin)) {
            write!(text, "{step}").ok();
            for column in 0..self.tags.len() {
                match row.get(column).copied().flatten() {
                    // The shortest text that reads back as the same number.
                    Some(value) => write!(text, ",{value:?}").ok(),
                    None => write!(text, ",").ok(),
                };
            }
            text.push('\n');
        }
        text
    }
}

/// Appends all of `bytes` or nothing.
fn append(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if bytes.is_empty() {
        return Ok(());
    }
    let mut file = OpenOptions::new().append(true).open(path)?;
    let length = file.metadata()?.len();
    let written = file.write_all(bytes).and_then(|()| file.sync_data());
    if written.is_err() {
        file.set_len(length).ok();
    }
    written
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_engine::ErrorKind;

    fn temporary(name: &str) -> PathBuf {
        std::env::temp_dir().join(format!("opendr-table-{name}-{}.csv", std::process::id()))
    }

    #[test]
    fn scalars_of_a_running_log_are_read() {
        let folder = std::env::temp_dir().join(format!("opendr-scalars-{}", std::process::id()));
        assert_eq!(read_scalars(&folder).unwrap(), []);
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join(TABLE), "step,loss,map\n1,0.5,\n2,0.25,0.1\n3,0.").unwrap();
        let scalars = read_scalars(&folder).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        let expected = [("loss", vec![[1.0, 0.5], [2.0, 0.25]]), ("map", vec![[2.0, 0.1]])];
        assert_eq!(scalars, expected.map(|(tag, points)| (tag.to_owned(), points)));
    }

    #[test]
    fn columns_and_values_can_be_added_later() {
        let path = temporary("columns");
        let text = || fs::read_to_string(&path).unwrap();
        let mut table = ScalarTable::new(path.clone());
        table.set("loss", 1, 0.5);
        table.write(false).unwrap();
        assert_eq!(text(), "step,loss\n");
        table.set("loss", 2, 0.25);
        table.write(false).unwrap();
        assert_eq!(text(), "step,loss\n1,0.5\n");
        table.write(true).unwrap();
        table.set("ap, small", 2, 1e-300);
        table.set("loss", 3, f64::NAN);
        table.write(true).unwrap();
        assert_eq!(text(), "step,loss,\"ap, small\"\n1,0.5,\n2,0.25,1e-300\n3,NaN,\n");
        let mut again = ScalarTable::read(path.clone(), 2).unwrap();
        assert_eq!(again.points("ap, small"), [[2.0, 1e-300]]);
        again.set("loss", 3, f64::INFINITY);
        again.write(true).unwrap();
        assert_eq!(text(), "step,loss,\"ap, small\"\n1,0.5,\n2,0.25,1e-300\n3,inf,\n");
        fs::remove_file(path).unwrap();
    }

    #[test]
    fn an_incomplete_line_is_dropped_and_an_invalid_one_reported() {
        let path = temporary("cut");
        fs::write(&path, "step,loss\n1,0.5\n2,0.").unwrap();
        assert_eq!(ScalarTable::read(path.clone(), 9).unwrap().points("loss"), [[1.0, 0.5]]);
        for broken in ["time,loss\n", "step,loss\n1\n", "step,loss\nx,1\n", "step,loss\n1,\"\n", "step\n-1\n"]
        {
            fs::write(&path, broken).unwrap();
            let error = ScalarTable::read(path.clone(), 9).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Format);
            assert!(error.to_string().contains("line "), "{error}");
        }
        fs::remove_file(&path).unwrap();
        assert!(ScalarTable::read(path, 9).unwrap().points("loss").is_empty());
    }
}
