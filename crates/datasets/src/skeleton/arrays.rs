//! Skeletons in one array, as prepared by ST-GCN and its successors.

use std::path::Path;

use opendr_engine::data::SkeletonSequence;
use opendr_engine::{Error, Result, ResultExt};

use super::sequence::finite_sequence;
use crate::folder::{files_in, read_bytes};
use crate::pickle::Pickle;
use crate::{NpyFile, Problem, Problems, array_from_npy};

const ENDINGS: [&str; 2] = ["_data.npy", "_data_joint.npy"];
const MAX_LABEL_BYTES: u64 = 256 << 20;

/// Returns the names before `_data.npy` in `path`.
pub(super) fn parts(path: &Path) -> Vec<String> {
    let part = |name: String| ENDINGS.iter().find_map(|ending| name.strip_suffix(ending).map(str::to_owned));
    files_in(path, &["npy"]).into_iter().filter_map(part).collect()
}

/// Opens the array, and reads the classes of its samples.
pub(super) fn open(
    path: &Path,
    part: &str,
    classes: Option<usize>,
    problems: &Problems,
) -> Result<(NpyFile, Vec<i64>)> {
    let file = ENDINGS.iter().map(|ending| path.join(format!("{part}{ending}"))).find(|file| file.is_file());
    let file = NpyFile::open(file.unwrap_or_else(|| path.join(format!("{part}_data.npy"))))?;
    let [samples, ..] = *file.shape() else {
        return Err(Problem::new(file.path(), "is a single value; save an array of samples").into());
    };
    if file.shape().len() != 5 {
        let message =
            format!("has shape {:?}; save [samples, channels, frames, joints, persons]", file.shape());
        return Err(Problem::new(file.path(), message).into());
    }
    let (label_path, mut labels) = labels(path, part)?;
    if labels.len() != samples {
        let message = format!("has {} classes for {samples} samples of {part}", labels.len());
        problems.report(Problem::new(&label_path, message))?;
        labels.truncate(samples);
    }
    for (index, class) in labels.iter().enumerate() {
        if *class < 0 || classes.is_some_and(|classes| *class >= classes as i64) {
            let upper =
                classes.map_or_else(String::new, |classes| format!(" to {}", classes.saturating_sub(1)));
            let message = format!("has class {class}; the classes are 0{upper}");
            problems.report(Problem::at_key(&label_path, format!("sample {index}"), message))?;
        }
    }
    Ok((file, labels))
}

/// Reads the classes of `PART_label.npy`, or of `PART_label.pkl` as written by ST-GCN: `(names, classes)`.
fn labels(path: &Path, part: &str) -> Result<(std::path::PathBuf, Vec<i64>)> {
    let file = path.join(format!("{part}_label.npy"));
    if file.is_file() {
        let read = || array_from_npy(&read_bytes(&file, MAX_LABEL_BYTES)?);
        let (_, numbers) = read().context(|| format!("reading {}", file.display()))?;
        return Ok((file, numbers.into_iter().map(|number| number as i64).collect()));
    }
    let file = path.join(format!("{part}_label.pkl"));
    let read = || {
        let pickle = Pickle::parse(&read_bytes(&file, MAX_LABEL_BYTES)?)?;
        let pair = pickle.root().list().unwrap_or_default();
        let classes = pair.get(1).ok_or_else(|| Error::format("is not a pair of names and classes"))?;
        if let Some((_, numbers)) = classes.array() {
            return Ok(numbers.into_iter().map(|number| number as i64).collect());
        }
        let classes: Option<Vec<i64>> =
            classes.list().unwrap_or_default().iter().map(|class| class.whole()).collect();
        classes.ok_or_else(|| Error::format("has a class that is not a number"))
    };
    let labels: Vec<i64> = read().context(|| format!("reading {}", file.display()))?;
    Ok((file, labels))
}

/// Reads sample `index`.
pub(super) fn part(file: &NpyFile, index: usize) -> Result<SkeletonSequence> {
    let numbers = file.part(index)?;
    let [_, channels, frames, joints, persons] = *file.shape() else {
        return Err(Problem::new(file.path(), "does not have five axes").into());
    };
    finite_sequence(&numbers, [1, channels, frames, joints, persons])
        .context(|| format!("{}: sample {index}", file.path().display()))
}
