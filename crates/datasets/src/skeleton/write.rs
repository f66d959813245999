//! Writer of skeletons as one array.

use std::path::Path;

use opendr_engine::data::SkeletonSequence;
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::{Error, Progress, Result, Value};

use crate::folder::{path_inside, write_file};
use crate::picture_files::write_each;
use crate::{Problems, WriteOptions, npy_from_values};

/// Largest number of values, which are collected in memory: 8 GiB.
const MAX_NUMBERS: usize = 2 << 30;

/// Writes `PART_data.npy`, `PART_label.npy` and, if classes have names, `label_map.txt`. All recordings must have
/// the same channels, joints and persons; shorter ones are padded with zeros.
pub(super) fn write(
    dataset: &dyn DatasetIterator,
    path: &Path,
    options: &WriteOptions,
    problems: &Problems,
    progress: &dyn Progress,
) -> Result<()> {
    let part = options.split.as_deref().unwrap_or("train");
    let data = path_inside(path, &format!("{part}_data.npy")).map_err(Error::invalid_param)?;
    let (mut sequences, mut labels) = (Vec::new(), Vec::new());
    write_each(dataset, problems, progress, |index| {
        let (sequence, class) = recording(dataset, index, sequences.first())?;
        sequences.push(sequence);
        labels.push(class);
        Ok(())
    })?;
    let frames = sequences.iter().map(|sequence: &SkeletonSequence| sequence.shape()[2]).max().unwrap_or(0);
    let [_, channels, _, joints, persons] = sequences.first().map_or([1; 5], SkeletonSequence::shape);
    let shape = [sequences.len(), channels, frames, joints, persons];
    let count = shape.iter().try_fold(1usize, |count, side| count.checked_mul(*side));
    let count = count.filter(|count| *count <= MAX_NUMBERS).ok_or_else(|| {
        Error::invalid_input(format!("an array of shape {shape:?} is too large; write fewer samples"))
    })?;
    let mut numbers = Vec::with_capacity(count);
    for sequence in &sequences {
        for channel in sequence.as_slice().chunks(sequence.shape()[2] * joints * persons) {
            let end = numbers.len() + frames * joints * persons;
            numbers.extend(channel);
            numbers.resize(end, 0.0);
        }
    }
    write_file(&data, &npy_from_values(&numbers, &shape)?)?;
    write_file(&path.join(format!("{part}_label.npy")), &npy_from_values(&labels, &[labels.len()])?)?;
    let names: String = dataset.classes().iter().map(|name| format!("{name}\n")).collect();
    if names.is_empty() { Ok(()) } else { write_file(&path.join("label_map.txt"), names.as_bytes()) }
}

fn recording(
    dataset: &dyn DatasetIterator,
    index: usize,
    first: Option<&SkeletonSequence>,
) -> Result<(SkeletonSequence, i64)> {
    let sample = dataset.get(index)?;
    let (Some(Value::SkeletonSequence(sequence)), Some(Value::Category(category))) =
        (sample.data.into_iter().next(), sample.target)
    else {
        return Err(Error::invalid_input("the sample needs a SkeletonSequence and a Category"));
    };
    let side = |sequence: &SkeletonSequence| {
        let [samples, channels, _, joints, persons] = sequence.shape();
        [samples, channels, joints, persons]
    };
    let expected = first.map_or(side(&sequence), side);
    if side(&sequence) != expected || expected.first() != Some(&1) {
        return Err(Error::invalid_input(format!(
            "{:?} samples, channels, joints and persons instead of {expected:?}, one sample each",
            side(&sequence)
        )));
    }
    Ok((sequence, category.class))
}
