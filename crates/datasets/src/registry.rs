//! Which formats there are: one line each.

use std::path::Path;

use opendr_engine::dataset::{DatasetIterator, ExternalDataset};
use opendr_engine::{Error, Result};

use crate::{FormatEntry, OpenOptions, Problems, Recognition};

/// Every format; of several that may be meant, the first is taken.
pub const fn formats() -> &'static [FormatEntry] {
    FORMATS
}

#[rustfmt::skip] // One line a format.
const FORMATS: &[FormatEntry] = &[
    FormatEntry::of::<crate::CocoPanoptic>(),
    FormatEntry::of::<crate::CocoInfrared>(),
    FormatEntry::of::<crate::Coco>(),
    FormatEntry::of::<crate::Yolo>(),
    FormatEntry::of::<crate::Voc>(),
    FormatEntry::of::<crate::WiderFace>(),
    FormatEntry::of::<crate::Cityscapes>(),
    FormatEntry::of::<crate::CamVid>(),
    FormatEntry::of::<crate::Mot>(),
    FormatEntry::of::<crate::Kitti>(),
    FormatEntry::of::<crate::KittiTracking>(),
    FormatEntry::of::<crate::SpeechCommands>(),
    FormatEntry::of::<crate::Wfdb>(),
    FormatEntry::of::<crate::Mnist>(),
    FormatEntry::of::<crate::ImageNet>(),
    FormatEntry::of::<crate::Kinetics>(),
    FormatEntry::of::<crate::Skeletons>(),
    FormatEntry::of::<crate::Ucr>(),
    FormatEntry::of::<crate::Lfw>(),
    FormatEntry::of::<crate::Market1501>(),
    FormatEntry::of::<crate::Hands>(),
    #[cfg(feature = "recordings")] FormatEntry::of::<crate::AnnotatedRecording>(),
];

/// The format called `name`, by its name or another that is used for it; upper and lower case are the same.
///
/// # Errors
/// `NotFound`, with the names that there are.
pub fn find(name: &str) -> Result<&'static FormatEntry> {
    let name = name.to_lowercase();
    formats().iter().find(|entry| entry.name == name || entry.aliases.contains(&&*name)).ok_or_else(|| {
        let names: Vec<_> = formats().iter().map(|entry| entry.name).collect();
        Error::not_found(format!("no data set format {name:?}; there are {}", names.join(", ")))
    })
}

/// The format of the data set at `path`.
///
/// # Errors
/// `NotFound` when there is nothing; `InvalidInput` when it is of no format, with what each misses.
pub fn recognise(path: &Path) -> Result<&'static FormatEntry> {
    if !path.exists() {
        return Err(Error::not_found(format!("there is no data set at {}", path.display())));
    }
    let (mut possible, mut missing) = (None, String::new());
    for entry in formats() {
        match (entry.recognise)(path) {
            Recognition::Certain => return Ok(entry),
            Recognition::Possible => possible = possible.or(Some(entry)),
            Recognition::No(what) => missing.push_str(&format!("\n  {}: {what}", entry.name)),
        }
    }
    possible.ok_or_else(|| {
        let path = path.display();
        Error::invalid_input(format!(
            "{path} is no data set of a known format; name the format if it should be one. Missing for{missing}"
        ))
    })
}

/// The format of a data set: the one that it names or, for `""` and `"auto"`, what is recognised.
///
/// # Errors
/// As [`find`] and [`recognise`].
pub fn format_of(dataset: &ExternalDataset) -> Result<&'static FormatEntry> {
    match dataset.dataset_type() {
        "" | "auto" => recognise(dataset.path()),
        name => find(name),
    }
}

/// Opens a data set of the format that [`format_of`] tells.
///
/// # Errors
/// As [`format_of`] and [`Format::open`](crate::Format::open).
pub fn open(
    dataset: &ExternalDataset,
    options: &OpenOptions,
    problems: &Problems,
) -> Result<Box<dyn DatasetIterator>> {
    (format_of(dataset)?.open)(dataset.path(), options, problems)
}
