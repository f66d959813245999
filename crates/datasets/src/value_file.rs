//! Values in single files: the inputs of learners on the command line and in other languages.

use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use opendr_engine::data::{Observation, SkeletonSequence, Timeseries, Vector};
use opendr_engine::{Error, Result, ResultExt, Value, ValueType};
use opendr_vision::Decoder;

use crate::clip::{CLIPS, open_clip};
use crate::folder::{PICTURES, has_extension, names_in, read_bytes};
use crate::{array_from_npy, open_velodyne, open_wav};

/// Largest size of a file in bytes; data sets have readers of their own.
const MAX_BYTES: u64 = 256 << 20;

/// Returns the file extensions of a type; empty for a type without a file format.
pub const fn value_extensions(kind: ValueType) -> &'static [&'static str] {
    match kind {
        ValueType::Image => &["jpg", "jpeg", "png", "bmp", "webp"],
        ValueType::Audio => &["wav"],
        ValueType::Timeseries | ValueType::Observation | ValueType::Vector => &["csv", "tsv", "txt", "npy"],
        ValueType::SkeletonSequence => &["npy"],
        ValueType::PointCloud => &["bin"],
        ValueType::Video => CLIPS,
        kind if kind.is_target() => &["json"],
        _ => &[],
    }
}

/// Reads the file at `path` as a value of the type `kind`:
///
/// * `Image`: JPEG, PNG, BMP, WebP; a grey PNG of 16 bits keeps its depth, as needed for depth images;
/// * `Audio`: WAVE;
/// * `Timeseries`: a table of numbers, with a line per time step and a column per feature, separated by commas,
///   semicolons,
///   tabs or blanks, with an optional line of names at the top, or a `.npy` of one or two axes;
/// * `Observation` and `Vector`: such a table, read line by line;
/// * `SkeletonSequence`: a `.npy` of five axes, or of three: frames, joints and channels of one person;
/// * `PointCloud`: a lidar scan in KITTI's format;
/// * `Video`: a video file, a folder of images as frames, or a `.npy` of four axes: channels, frames, height,
///   width. Frames
///   of more than 640 pixels a side are resized, and clips of more than 256 MB are subsampled evenly;
/// * targets: their JSON.
///
/// # Errors
/// `Unsupported` for a type without a file format, `NotFound` or `Io` if the file cannot be read, `Format` for
/// other content; all with the path.
pub fn open_value(kind: ValueType, path: impl AsRef<Path>) -> Result<Value> {
    let path = path.as_ref();
    let opening = || format!("opening {}", path.display());
    match kind {
        ValueType::Image if is_deep_grey(path) => Decoder::default().open_depth(path).map(Value::Image),
        ValueType::Image => opendr_vision::open(path).map(Value::Image),
        ValueType::Audio => open_wav(path).map(Value::Audio),
        ValueType::PointCloud => open_velodyne(path).map(Value::PointCloud),
        ValueType::Video => open_clip(path).map(Value::Video),
        ValueType::Timeseries => {
            timeseries_from_table(&read_bytes(path, MAX_BYTES)?).map(Value::Timeseries).context(opening)
        }
        ValueType::Observation => {
            numbers(path).and_then(Observation::from_data).map(Value::Observation).context(opening)
        }
        ValueType::Vector => numbers(path).and_then(Vector::from_data).map(Value::Vector).context(opening),
        ValueType::SkeletonSequence => {
            skeletons_from_npy(&read_bytes(path, MAX_BYTES)?).map(Value::SkeletonSequence).context(opening)
        }
        kind if kind.is_target() => {
            let value: Value = serde_json::from_slice(&read_bytes(path, MAX_BYTES)?).map_err(|error| {
                Error::format(format!("not the JSON of a target: {error}")).context(opening())
            })?;
            match value.as_value_ref().value_type() {
                given if given == kind => Ok(value),
                given => {
                    let (given, expected) = (given.name(), kind.name());
                    Err(Error::format(format!("the file has a {given} instead of a {expected}"))
                        .context(opening()))
                }
            }
        }
        kind => Err(Error::unsupported(format!(
            "{} has no file format; construct it from its parts in Rust, Python or C",
            kind.name()
        ))),
    }
}

/// Returns the files of the type `kind` at `path`: the file itself, or those in the folder, in order. A folder of
/// images is one clip.
///
/// # Errors
/// `NotFound` if the path does not exist or the folder has no file of the type, `Io` if it cannot be read.
pub fn value_files(kind: ValueType, path: &Path) -> Result<Vec<PathBuf>> {
    if !path.is_dir() {
        let exists = path.try_exists().context(|| format!("opening {}", path.display()))?;
        return if exists {
            Ok(vec![path.to_owned()])
        } else {
            Err(Error::not_found(format!("no file {}", path.display())))
        };
    }
    let mut names = names_in(path)?;
    let is_clip = kind == ValueType::Video && names.iter().any(|name| has_extension(name, PICTURES));
    names.retain(|name| has_extension(name, value_extensions(kind)));
    if names.is_empty() && is_clip {
        return Ok(vec![path.to_owned()]);
    }
    if names.is_empty() {
        let endings = value_extensions(kind).join(", .");
        return Err(Error::not_found(format!("no file .{endings} in the folder {}", path.display())));
    }
    Ok(names.iter().map(|name| path.join(name)).collect())
}

/// Returns whether the file is a grey PNG of 16 bits; false if it cannot be read, which the caller reports.
fn is_deep_grey(path: &Path) -> bool {
    let mut header = [0; 26];
    let read = File::open(path).and_then(|mut file| file.read_exact(&mut header));
    read.is_ok() && header.starts_with(b"\x89PNG") && header[24..] == [16, 0]
}

/// Reads all numbers of a table, line by line.
fn numbers(path: &Path) -> Result<Vec<f32>> {
    let table = timeseries_from_table(&read_bytes(path, MAX_BYTES)?)?;
    Ok(table.as_slice().to_vec())
}

/// Parses skeletons from the bytes of an `.npy` file: `[samples, channels, frames, joints, persons]`, or
/// `[frames, joints, channels]` of one person.
///
/// # Errors
/// `Format` for other axes or invalid values.
fn skeletons_from_npy(bytes: &[u8]) -> Result<SkeletonSequence> {
    let (shape, numbers) = array_from_npy(bytes)?;
    let numbers: Vec<_> = numbers.into_iter().map(|number| number as f32).collect();
    match shape[..] {
        [samples, channels, frames, joints, persons] => {
            SkeletonSequence::new(numbers, [samples, channels, frames, joints, persons])
        }
        [frames, joints, channels] => {
            let of_channel = |channel| numbers.iter().skip(channel).step_by(channels);
            let by_channel: Vec<_> = (0..channels.min(numbers.len())).flat_map(of_channel).copied().collect();
            SkeletonSequence::new(by_channel, [1, channels, frames, joints, 1])
        }
        _ => Err(Error::format(format!(
            "{} axes; skeleton sequences have five (samples, channels, frames, joints, persons) or three (frames, joints, \
            channels)",
            shape.len()
        ))),
    }
}

/// Parses a time series `[time, features]` from a text table or the bytes of an `.npy` file.
///
/// # Errors
/// `Format` with the line if a text is not a table of finite numbers, or if an array has more than two axes.
pub fn timeseries_from_table(bytes: &[u8]) -> Result<Timeseries> {
    if bytes.starts_with(b"\x93NUMPY") {
        let (shape, numbers) = array_from_npy(bytes)?;
        let shape = match shape[..] {
            [time] => [time, 1],
            [time, features] => [time, features],
            _ => {
                return Err(Error::format(format!(
                    "{} axes; a time series has time and features",
                    shape.len()
                )));
            }
        };
        return Timeseries::new(numbers.into_iter().map(|number| number as f32).collect::<Vec<_>>(), shape);
    }
    let text = std::str::from_utf8(bytes)
        .map_err(|_| Error::format("not a text; a time series is a table of numbers"))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut numbers: Vec<f32> = Vec::new();
    let mut columns = 0;
    let lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
    for (at, (line, text)) in lines.enumerate() {
        let cells = cells(text);
        let row: Vec<f32> = match cells.iter().map(|cell| cell.parse()).collect() {
            Ok(row) => row,
            // The line of column names.
            Err(_) if at == 0 && cells.iter().all(|cell| cell.parse::<f32>().is_err()) => {
                columns = cells.len();
                continue;
            }
            Err(error) => {
                return Err(Error::format(format!("line {line} has a column without a number: {error}")));
            }
        };
        if columns == 0 {
            columns = row.len();
        }
        if row.len() != columns {
            let given = row.len();
            return Err(Error::format(format!(
                "line {line} has {given} numbers, the first line has {columns}"
            )));
        }
        if let Some(number) = row.iter().find(|number| !number.is_finite()) {
            return Err(Error::format(format!("line {line} has {number}; numbers must be finite")));
        }
        numbers.extend(row);
    }
    let time = numbers.len().checked_div(columns).unwrap_or(0);
    if time == 0 {
        return Err(Error::format(
            "no numbers; a time series has a line per time step and a column per feature",
        ));
    }
    Timeseries::new(numbers, [time, columns])
}

/// Splits at commas, semicolons or tabs, otherwise at blanks.
fn cells(line: &str) -> Vec<&str> {
    match line.find([',', ';', '\t']).and_then(|at| line[at..].chars().next()) {
        Some(separator) => line.split(separator).map(str::trim).collect(),
        None => line.split_whitespace().collect(),
    }
}

#[cfg(test)]
mod tests;
