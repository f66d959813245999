//! The trait of data set formats.

use std::path::Path;

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::{Error, Progress, Result, ValueType};

use crate::{Problems, Recognition};

/// A data set format, which can be recognised, read and written.
///
/// Opening reads indices and lists, never bulk data. Bulk data is read by [`DatasetIterator::get`], which fails
/// only for broken samples.
pub trait Format: DatasetIterator + Sized + 'static {
    /// Name of the format on the command line, e.g. `"coco"`.
    const NAME: &'static str;
    /// Other names of the format in OpenDR and other toolkits.
    const ALIASES: &'static [&'static str] = &[];
    /// Description in one line.
    const ABOUT: &'static str;
    /// Files and folders of the format, for help texts and errors.
    const LAYOUT: &'static str;
    /// Target types as which the annotations can be read, the default one first.
    const TARGETS: &'static [ValueType];

    /// Checks whether `path` is such a data set, by names and the first bytes of files; otherwise returns what is
    /// missing.
    fn recognise(path: &Path) -> Recognition;

    /// Opens the data set.
    ///
    /// # Errors
    /// `InvalidInput` if `options` ask for a target type that the format does not have; else as [`Format::read_index`].
    fn open(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        match options.target {
            Some(other) if !Self::TARGETS.contains(&other) => Err(Error::invalid_input(format!(
                "a data set of format {} has {}, not {}; choose another target type, or name another format",
                Self::NAME,
                names_of_types(Self::TARGETS),
                other.name()
            ))),
            _ => Self::read_index(path, options, problems),
        }
    }

    /// Opens the data set with the target type of `options`, which is one of [`Format::TARGETS`].
    ///
    /// # Errors
    /// `NotFound` if `path` is not such a data set, with what is missing; `Format` for broken files, unless
    /// `problems` skips them.
    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self>;

    /// Writes any data set in this format.
    ///
    /// # Errors
    /// `Unsupported` if the format has no writer, `InvalidInput` for targets that the format does not support, and
    /// `Io`.
    fn write(
        _dataset: &dyn DatasetIterator,
        _path: &Path,
        _options: &WriteOptions,
        _problems: &Problems,
        _progress: &dyn Progress,
    ) -> Result<()> {
        Err(Error::unsupported(format!(
            "the format {} cannot be written; \"opendr data formats\" lists the formats that can",
            Self::NAME
        )))
    }
}

/// Returns the names of target types for a message.
pub(crate) fn names_of_types(types: &[ValueType]) -> String {
    types.iter().map(|target| target.name()).collect::<Vec<_>>().join(" or ")
}

/// Options of reading a data set.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct OpenOptions {
    /// Name of the part in the data set: `"val2017"`, `"train"`, `"testing"`. By default the only one, or the first
    /// existing one of val, test, train.
    pub split: Option<String>,
    /// Target type, for annotations that can be read as several; by default the first available one.
    pub target: Option<ValueType>,
}

/// Options of writing a data set.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct WriteOptions {
    /// Name of the part; by default `"train"`, or the name that the format uses.
    pub split: Option<String>,
    /// Whether unchanged files are hard-linked instead of copied, if the file system supports it.
    pub link: bool,
}
