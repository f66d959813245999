//! The list of formats.

use std::path::Path;

use opendr_engine::dataset::{DatasetIterator, ExternalDataset};
use opendr_engine::{Error, Result, ValueType};

use crate::format::names_of_types;
use crate::{FormatEntry, OpenOptions, Problems, Recognition};

/// Returns all formats. If several recognise a path, the first one is used.
pub const fn formats() -> &'static [FormatEntry] {
    FORMATS
}

#[rustfmt::skip] // One line per format.
const FORMATS: &[FormatEntry] = &[
    FormatEntry::of::<crate::CocoPanoptic>(),
    FormatEntry::of::<crate::CocoInfrared>(),
    FormatEntry::of::<crate::Coco>(),
    FormatEntry::of::<crate::Yolo>(),
    FormatEntry::of::<crate::Voc>(),
    FormatEntry::of::<crate::WiderFace>(),
    FormatEntry::of::<crate::Cityscapes>(),
    FormatEntry::of::<crate::CamVid>(),
    FormatEntry::of::<crate::DepthMaps>(),
    FormatEntry::of::<crate::Icdar>(),
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

/// Returns the format `name`, by its name or an alias, in upper or lower case.
///
/// # Errors
/// `NotFound`, with the list of names.
pub fn find_format(name: &str) -> Result<&'static FormatEntry> {
    let name = name.to_lowercase();
    formats().iter().find(|entry| entry.name == name || entry.aliases.contains(&&*name)).ok_or_else(|| {
        let names: Vec<_> = formats().iter().map(|entry| entry.name).collect();
        Error::not_found(format!("no data set format {name:?}; choose one of {}", names.join(", ")))
    })
}

/// Recognises the format of the data set at `path`.
///
/// # Errors
/// `NotFound` if the path does not exist; `InvalidInput` if no format recognises it, with what each of them misses.
pub fn recognise(path: &Path) -> Result<&'static FormatEntry> {
    if !path.exists() {
        return Err(Error::not_found(format!("no data set at {}: the path does not exist", path.display())));
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
            "{path} is not a data set of a known format; name the format if it should be one. Missing for{missing}"
        ))
    })
}

/// Returns the format of a data set: the named one or, for `""` and `"auto"`, the recognised one.
///
/// # Errors
/// As [`find_format`] and [`recognise`].
pub fn format_of(dataset: &ExternalDataset) -> Result<&'static FormatEntry> {
    match dataset.dataset_type() {
        "" | "auto" => recognise(dataset.path()),
        name => find_format(name),
    }
}

/// Opens a data set with the format of [`format_of`].
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

/// Opens a data set with the first type of annotation of its format that is `accepted`. `need` states in the error who needs the
/// annotations, such as "map needs the annotations".
///
/// # Errors
/// `InvalidInput` if the format has none of the types; else as [`open`].
pub fn open_for(
    need: &str,
    accepted: &[ValueType],
    dataset: &ExternalDataset,
    split: Option<String>,
    problems: &Problems,
) -> Result<Box<dyn DatasetIterator>> {
    let format = format_of(dataset)?;
    let target = format.targets.iter().find(|target| accepted.contains(target)).copied();
    if target.is_none() {
        let (needed, has) = (names_of_types(accepted), names_of_types(format.targets));
        return Err(Error::invalid_input(format!(
            "{need} {needed}, but a data set of format {} has {has}; use another data set, or name \
             another format",
            format.name
        )));
    }
    (format.open)(dataset.path(), &OpenOptions { split, target }, problems)
}
