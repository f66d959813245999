//! Poses in a pickle: JHMDB as prepared by DD-Net, and annotations of MMAction2.

use std::path::Path;

use opendr_engine::data::SkeletonSequence;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, ResultExt};

use super::sequence::finite_sequence;
use crate::folder::{files_in, has_extension, name_of, read_bytes};
use crate::pickle::{Pickle, Pickled};

const MAX_BYTES: u64 = 1 << 30;

/// The poses of a pickle, in memory.
#[derive(Debug)]
pub(super) struct PickledPoses {
    pickle: Pickle,
    classes: Vec<i64>,
    layout: Layout,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Layout {
    /// `{"pose": [[frames, joints, channels]], "label": [name]}`.
    Jhmdb,
    /// `{"annotations": [{"keypoint": [persons, frames, joints, channels], "label": class}]}`.
    Mmaction,
}

/// Returns the names before `.pkl` at `path`.
pub(super) fn parts(path: &Path) -> Vec<String> {
    let names = match path.is_dir() {
        true => files_in(path, &["pkl"]),
        false => vec![name_of(path)].into_iter().filter(|name| has_extension(name, &["pkl"])).collect(),
    };
    names.into_iter().filter_map(|name| name.strip_suffix(".pkl").map(str::to_owned)).collect()
}

impl PickledPoses {
    /// Reads a pickle. Class names are numbered as in `known`, or in alphabetical order.
    pub(super) fn open(path: &Path, known: Option<&Classes>) -> Result<(Self, Classes)> {
        let read = || {
            let pickle = Pickle::parse(&read_bytes(path, MAX_BYTES)?)?;
            let (layout, labels): (_, Vec<_>) =
                match (pickle.root().get("pose"), pickle.root().get("annotations")) {
                    (Some(_), _) => (
                        Layout::Jhmdb,
                        pickle.root().get("label").and_then(Pickled::list).unwrap_or_default(),
                    ),
                    (_, Some(annotations)) => {
                        let labels = annotations.list().unwrap_or_default();
                        (
                            Layout::Mmaction,
                            labels.iter().filter_map(|annotation| annotation.get("label")).collect(),
                        )
                    }
                    _ => return Err(Error::format("has neither \"pose\" and \"label\" nor \"annotations\"")),
                };
            let classes = names(&labels, known);
            let numbers: Option<Vec<i64>> =
                labels.iter().map(|label| label.whole().or_else(|| classes.index(label.text()?))).collect();
            let numbers = numbers.ok_or_else(|| Error::format("has a label that is not a class"))?;
            let poses = Self { classes: numbers, layout, pickle };
            let count = poses.list().len();
            if count != poses.classes.len() {
                return Err(Error::format(format!("has {count} poses and {} labels", poses.classes.len())));
            }
            Ok((poses, classes))
        };
        read().context(|| format!("reading {}", path.display()))
    }

    fn list(&self) -> Vec<Pickled<'_>> {
        let key = if self.layout == Layout::Jhmdb { "pose" } else { "annotations" };
        self.pickle.root().get(key).and_then(Pickled::list).unwrap_or_default()
    }

    pub(super) fn len(&self) -> usize {
        self.classes.len()
    }

    pub(super) fn class(&self, index: usize) -> Option<i64> {
        self.classes.get(index).copied()
    }

    pub(super) fn sequence(&self, index: usize) -> Result<SkeletonSequence> {
        let list = self.list();
        let pose = list.get(index).ok_or_else(|| Error::not_found("no such sample"))?;
        let pose = if self.layout == Layout::Jhmdb { Some(*pose) } else { pose.get("keypoint") };
        let (shape, numbers) =
            pose.and_then(Pickled::array).ok_or_else(|| Error::format("has no array of joints"))?;
        let [persons, frames, joints, channels] = match *shape {
            [frames, joints, channels] => [1, frames, joints, channels],
            [persons, frames, joints, channels] => [persons, frames, joints, channels],
            _ => {
                return Err(Error::format(format!(
                    "has shape {shape:?} instead of frames, joints, channels"
                )));
            }
        };
        let mut moved = Vec::with_capacity(numbers.len());
        for channel in 0..channels {
            for place in 0..frames * joints {
                let at = |person: usize| (person * frames * joints + place) * channels + channel;
                moved.extend((0..persons).filter_map(|person| numbers.get(at(person)).copied()));
            }
        }
        finite_sequence(&moved, [1, channels, frames, joints, persons])
    }
}

/// Returns the class names in alphabetical order; empty if classes are numbers.
fn names(labels: &[Pickled<'_>], known: Option<&Classes>) -> Classes {
    let mut names: Vec<_> = labels.iter().filter_map(|label| label.text()).collect();
    names.sort_unstable();
    names.dedup();
    match known {
        Some(known) if names.iter().all(|name| known.index(name).is_some()) => known.clone(),
        _ => names.into_iter().collect(),
    }
}
