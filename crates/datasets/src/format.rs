//! What a format is.

use std::path::Path;

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::{Error, Progress, Result, ValueType};

use crate::{Problems, Recognition};

/// A data set format: how to recognise, read and write it.
///
/// Opening reads what is needed to know the samples (indices, lists), never bulk data; those are read by
/// [`DatasetIterator::get`], which fails for a broken sample alone.
pub trait Format: DatasetIterator + Sized + 'static {
    /// The name, as users write it, e.g. `"coco"`.
    const NAME: &'static str;
    /// Other names that OpenDR or its peers use for it.
    const ALIASES: &'static [&'static str] = &[];
    /// In one line.
    const ABOUT: &'static str;
    /// Which files lie where, for the help and for the error when they do not.
    const LAYOUT: &'static str;
    /// The targets that its annotations can be read as, the usual one first.
    const TARGETS: &'static [ValueType];

    /// Whether `path` is such a data set, by names and the beginnings of files; what is missing when it is not.
    fn recognise(path: &Path) -> Recognition;

    /// Opens the data set.
    ///
    /// # Errors
    /// `NotFound` when `path` is no such data set, with what is missing; `Format` for broken files, unless `problems`
    /// skips them.
    fn open(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self>;

    /// Writes any data set in this format.
    ///
    /// # Errors
    /// `Unsupported` when there is no writer; `InvalidInput` for targets that the format cannot hold; `Io`.
    fn write(
        _dataset: &dyn DatasetIterator,
        _path: &Path,
        _options: &WriteOptions,
        _problems: &Problems,
        _progress: &dyn Progress,
    ) -> Result<()> {
        Err(Error::unsupported(format!(
            "there is no writer of {}; \"opendr data formats\" lists those",
            Self::NAME
        )))
    }
}

/// Which part of a data set is read.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct OpenOptions {
    /// The part, as the data set calls it: `"val2017"`, `"train"`, `"testing"`; by default the only one, or the one that
    /// is there of val, test, train.
    pub split: Option<String>,
    /// What targets are wanted, where annotations can be read as several; by default the first that is there.
    pub target: Option<ValueType>,
}

/// How a data set is written.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct WriteOptions {
    /// What to call the part; by default `"train"`, or what the format calls it.
    pub split: Option<String>,
    /// Hard links to files that are taken over as they are, instead of copies, where the file system can.
    pub link: bool,
}
