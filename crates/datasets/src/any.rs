//! Formats without their types: what surfaces hold.

use std::path::Path;

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::{Progress, Result, ValueType};

use crate::{Format, OpenOptions, Problems, WriteOptions};

/// Whether a path is a data set of some format.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Recognition {
    /// By files that no other format has.
    Certain,
    /// By files that other formats may have, too.
    Possible,
    /// It is not; what is missing.
    No(String),
}

type Open = fn(&Path, &OpenOptions, &Problems) -> Result<Box<dyn DatasetIterator>>;
type Write = fn(&dyn DatasetIterator, &Path, &WriteOptions, &Problems, &dyn Progress) -> Result<()>;

/// One format: its tables and functions.
pub struct FormatEntry {
    /// As users write it.
    pub name: &'static str,
    /// Other names.
    pub aliases: &'static [&'static str],
    /// In one line.
    pub about: &'static str,
    /// Which files lie where.
    pub layout: &'static str,
    /// What its annotations can be read as.
    pub targets: &'static [ValueType],
    /// As [`Format::recognise`].
    pub recognise: fn(&Path) -> Recognition,
    /// As [`Format::open`].
    pub open: Open,
    /// As [`Format::write`].
    pub write: Write,
}

impl FormatEntry {
    /// The entry of a format.
    pub(crate) const fn of<F: Format>() -> Self {
        Self {
            name: F::NAME,
            aliases: F::ALIASES,
            about: F::ABOUT,
            layout: F::LAYOUT,
            targets: F::TARGETS,
            recognise: F::recognise,
            open: |path, options, problems| Ok(Box::new(F::open(path, options, problems)?)),
            write: F::write,
        }
    }
}
