//! Skeleton sequences: NTU RGB+D's text files, NumPy arrays, and pickles of JHMDB and MMAction2.

use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Error, Progress, Result, ResultExt, Value, ValueType};

use crate::folder::{files_in, past_end};
use crate::{Format, NpyFile, OpenOptions, Problems, Recognition, WriteOptions};

mod arrays;
mod ntu;
mod pickled;
mod sequence;
mod write;

pub use ntu::{NtuFile, open_ntu, skeleton_from_ntu};

use pickled::PickledPoses;

/// Skeleton sequences with their action: a sample is one recording, `[1, channels, frames, joints, persons]`.
///
/// NTU RGB+D has metres and two persons, padded with zeros; its parts are `xsub_train`, `xsub_val`, `xview_train`
/// and `xview_val`. The parts of arrays are the names before `_data.npy`, of pickles those before `.pkl`.
#[derive(Debug)]
pub struct Skeletons {
    source: Source,
    classes: Classes,
}

#[derive(Debug)]
enum Source {
    /// Files of NTU RGB+D.
    Ntu(Vec<NtuFile>),
    /// An array `[samples, channels, frames, joints, persons]` and the classes.
    Arrays(NpyFile, Vec<i64>),
    /// All samples in one pickle.
    Pickle(PathBuf, PickledPoses),
}

impl Skeletons {
    fn class(&self, index: usize) -> Result<i64> {
        let class = match &self.source {
            Source::Ntu(files) => files.get(index).map(NtuFile::class),
            Source::Arrays(_, labels) => labels.get(index).copied(),
            Source::Pickle(_, poses) => poses.class(index),
        };
        class.ok_or_else(|| past_end(index, self.len()))
    }
}

impl Dataset for Skeletons {}

impl DatasetIterator for Skeletons {
    fn len(&self) -> usize {
        match &self.source {
            Source::Ntu(files) => files.len(),
            Source::Arrays(_, labels) => labels.len(),
            Source::Pickle(_, poses) => poses.len(),
        }
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let target = self.target(index)?;
        let past = || past_end(index, self.len());
        let sequence = match &self.source {
            Source::Ntu(files) => open_ntu(files.get(index).ok_or_else(past)?.path())?,
            Source::Arrays(file, _) => arrays::part(file, index)?,
            Source::Pickle(path, poses) => {
                poses.sequence(index).context(|| format!("{}: sample {index}", path.display()))?
            }
        };
        Ok(Sample { data: vec![Value::SkeletonSequence(sequence)], target })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        let class = self.class(index)?;
        let description = self.classes.name(class).cloned();
        Ok(Some(Value::Category(Category { description, ..Category::new(class, Some(1.0)) })))
    }

    fn name(&self, index: usize) -> String {
        let named = match &self.source {
            Source::Ntu(files) => files.get(index).map(|file| crate::folder::name_of(file.path())),
            _ => None,
        };
        named.unwrap_or_else(|| index.to_string())
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        match &self.source {
            Source::Ntu(files) => files.get(index).map(|file| file.path().to_owned()),
            Source::Arrays(file, _) => Some(file.path().to_owned()),
            Source::Pickle(path, _) => Some(path.clone()),
        }
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }
}

impl Format for Skeletons {
    const NAME: &'static str = "skeleton";
    const ALIASES: &'static [&'static str] = &["nturgbd", "ntu", "kinetics_skeleton", "jhmdb"];
    const ABOUT: &'static str = "skeleton sequences: NTU RGB+D, NumPy arrays, pickles of JHMDB and MMAction2";
    const LAYOUT: &'static str = "S001C001P001R001A001.skeleton files; or PART_data.npy [samples, channels, frames, joints, persons] \
                                  with PART_label.npy or PART_label.pkl; or a .pkl file of poses; label_map.txt may name the classes";
    const TARGETS: &'static [ValueType] = &[ValueType::Category];

    fn recognise(path: &Path) -> Recognition {
        if !ntu::files(path).is_empty() || !arrays::parts(path).is_empty() {
            return Recognition::Certain;
        }
        match pickled::parts(path).is_empty() {
            false => Recognition::Possible,
            true => Recognition::No(
                ".skeleton files, a PART_data.npy with its PART_label, or a .pkl file of poses".into(),
            ),
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let names = class_names(path);
        let split = options.split.as_deref();
        let files = ntu::files(path);
        if !files.is_empty() {
            let files = ntu::part(path, files, split, problems)?;
            return Ok(Self { source: Source::Ntu(files), classes: names.unwrap_or_else(ntu::classes) });
        }
        if let Some(part) = select_part(&arrays::parts(path), split)? {
            let (file, labels) = arrays::open(path, &part, names.as_ref().map(Classes::len), problems)?;
            return Ok(Self { source: Source::Arrays(file, labels), classes: names.unwrap_or_default() });
        }
        if let Some(part) = select_part(&pickled::parts(path), split)? {
            let file = if path.is_dir() { path.join(format!("{part}.pkl")) } else { path.to_owned() };
            let (poses, own_classes) = PickledPoses::open(&file, names.as_ref())?;
            return Ok(Self {
                source: Source::Pickle(file, poses),
                classes: if own_classes.is_empty() { names.unwrap_or_default() } else { own_classes },
            });
        }
        let (path, layout) = (path.display(), Self::LAYOUT);
        Err(Error::not_found(format!("no skeletons in {path}; the layout is {layout}")))
    }

    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        write::write(dataset, path, options, problems, progress)
    }
}

/// Returns the selected part, or the first existing one of val, test, train; `None` if there are no parts.
fn select_part(parts: &[String], selected: Option<&str>) -> Result<Option<String>> {
    let Some(first) = parts.first() else { return Ok(None) };
    let Some(selected) = selected else {
        let usual =
            ["val", "test", "train"].iter().find_map(|usual| parts.iter().find(|part| part.contains(usual)));
        return Ok(Some(usual.unwrap_or(first).clone()));
    };
    // OpenDR names files such as GT_train_1.
    let exact = parts.iter().find(|part| *part == selected);
    let found = exact.or_else(|| parts.iter().find(|part| part.split('_').any(|word| word == selected)));
    found
        .cloned()
        .map(Some)
        .ok_or_else(|| Error::not_found(format!("no part {selected:.40?}; there are {}", parts.join(", "))))
}

/// Reads the class names, one per line, of `label_map*.txt` beside the data.
fn class_names(path: &Path) -> Option<Classes> {
    let folder = if path.is_dir() { path } else { path.parent()? };
    let name = files_in(folder, &["txt"]).into_iter().find(|name| name.starts_with("label_map"))?;
    let text = crate::folder::read_text(&folder.join(name)).ok()?;
    Some(text.lines().map(str::trim).filter(|line| !line.is_empty()).map(str::to_owned).collect())
}

#[cfg(test)]
mod tests;
