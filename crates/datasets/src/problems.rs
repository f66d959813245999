//! Problems of a data set with their location.

use std::fmt;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

/// Largest number of problems that are kept; further ones are only counted.
const MAX_KEPT: usize = 10_000;

/// Location in a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Location {
    /// Line number, from 1.
    Line(u64),
    /// Byte offset, from 0.
    Byte(u64),
    /// Key of JSON or XML, a field, or the index of an annotation.
    Key(String),
}

/// A problem of a data set.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Problem {
    /// File of the problem.
    pub file: PathBuf,
    /// Location in the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[serde(alias = "place")]
    pub location: Option<Location>,
    /// Description with the values, and what to do.
    pub message: String,
}

impl Problem {
    /// Creates a problem of a whole file.
    pub fn new(file: impl Into<PathBuf>, message: impl Into<String>) -> Self {
        Self { file: file.into(), location: None, message: message.into() }
    }

    /// Converts an error to a problem; an error without a location is a problem of the file of sample `at`.
    pub fn of(error: &Error, dataset: &dyn DatasetIterator, at: usize) -> Self {
        let source = std::error::Error::source(error).and_then(|source| source.downcast_ref::<Self>());
        source.cloned().unwrap_or_else(|| Self::new(file_of(dataset, at), error.to_string()))
    }

    /// Creates a problem of a line, from 1.
    pub fn at_line(file: impl Into<PathBuf>, line: u64, message: impl Into<String>) -> Self {
        Self { location: Some(Location::Line(line)), ..Self::new(file, message) }
    }

    /// Creates a problem at a byte offset, from 0.
    pub fn at_byte(file: impl Into<PathBuf>, byte: u64, message: impl Into<String>) -> Self {
        Self { location: Some(Location::Byte(byte)), ..Self::new(file, message) }
    }

    /// Creates a problem of a key or field.
    pub fn at_key(file: impl Into<PathBuf>, key: impl Into<String>, message: impl Into<String>) -> Self {
        Self { location: Some(Location::Key(key.into())), ..Self::new(file, message) }
    }
}

/// Returns the file of a sample, or the name of the sample.
pub(crate) fn file_of(dataset: &dyn DatasetIterator, at: usize) -> PathBuf {
    dataset.path(at).unwrap_or_else(|| dataset.name(at).into())
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        match &self.location {
            Some(Location::Line(line)) => write!(f, ":{line}")?,
            Some(Location::Byte(byte)) => write!(f, " at byte {byte}")?,
            Some(Location::Key(key)) => write!(f, " at {key}")?,
            None => {}
        }
        write!(f, ": {}", self.message)
    }
}

impl std::error::Error for Problem {}

/// The problem is the source of the error, so that [`Problem::of`] can return it.
impl From<Problem> for Error {
    fn from(problem: Problem) -> Self {
        Self::format(problem.to_string()).with_source(problem)
    }
}

/// Collects problems, or fails with the first one.
#[derive(Debug, Default)]
pub struct Problems {
    skip: bool,
    kept: Mutex<(Vec<Problem>, u64)>,
}

impl Problems {
    /// Creates a list that skips and counts broken parts if `skip_broken`, else one whose first problem is an error.
    pub fn new(skip_broken: bool) -> Self {
        Self { skip: skip_broken, ..Self::default() }
    }

    /// Creates a list of problems whose first one is an error.
    pub fn strict() -> Self {
        Self::new(false)
    }

    /// Skips broken parts, which are counted and listed.
    pub fn skipping() -> Self {
        Self::new(true)
    }

    /// Returns whether broken parts are skipped.
    pub fn skips(&self) -> bool {
        self.skip
    }

    /// Reports a problem; the caller skips the broken part and continues, unless this fails.
    ///
    /// # Errors
    /// The problem in strict mode.
    pub fn report(&self, problem: Problem) -> Result<()> {
        if !self.skip {
            return Err(problem.into());
        }
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.1 += 1;
        if kept.0.len() < MAX_KEPT {
            kept.0.push(problem);
        }
        Ok(())
    }

    /// Returns the number of problems.
    pub fn count(&self) -> u64 {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).1
    }

    /// Returns the first ten thousand problems.
    pub fn list(&self) -> Vec<Problem> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).0.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strict_stops_and_skipping_counts() {
        let problem = || Problem::at_line("gt.txt", 7, "10 columns, not 9");
        let error = Problems::strict().report(problem()).unwrap_err();
        let source = std::error::Error::source(&error).unwrap();
        assert_eq!(source.downcast_ref::<Problem>(), Some(&problem()));
        assert_eq!(error.to_string(), "gt.txt:7: 10 columns, not 9");
        let problems = Problems::skipping();
        for _ in 0..MAX_KEPT + 5 {
            problems.report(problem()).unwrap();
        }
        assert_eq!((problems.count(), problems.list().len()), (MAX_KEPT as u64 + 5, MAX_KEPT));
    }
}
