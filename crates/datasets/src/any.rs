//! Entries of the format registry.

use std::path::Path;

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::{Progress, Result, ValueType};

use crate::{Format, OpenOptions, Problems, Recognition, WriteOptions};

type Open = fn(&Path, &OpenOptions, &Problems) -> Result<Box<dyn DatasetIterator>>;
type Write = fn(&dyn DatasetIterator, &Path, &WriteOptions, &Problems, &dyn Progress) -> Result<()>;

/// A format of the registry: its descriptions and functions.
pub struct FormatEntry {
    /// Name of the format on the command line.
    pub name: &'static str,
    /// Other names.
    pub aliases: &'static [&'static str],
    /// Description in one line.
    pub about: &'static str,
    /// Files and folders of the format.
    pub layout: &'static str,
    /// Types as which its annotations can be read.
    pub targets: &'static [ValueType],
    /// As [`Format::recognise`].
    pub recognise: fn(&Path) -> Recognition,
    /// As [`Format::open`].
    pub open: Open,
    /// As [`Format::write`].
    pub write: Write,
}

impl FormatEntry {
    /// Returns the entry of a format.
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
