//! Records: header, signals and annotations.

use std::path::{Path, PathBuf};

use opendr_engine::data::Timeseries;
use opendr_engine::{Error, Result};

use super::annotation::{WfdbAnnotation, annotations_from_atr};
use super::header::WfdbHeader;
use super::signal::wfdb_samples;
use crate::Problem;
use crate::folder::{path_inside, read_bytes, read_text};

/// Largest size of a signal file in bytes: a day of three signals at 500 Hz and 16 bits takes 259 MB.
const MAX_BYTES: u64 = 260 << 20;

/// A record: signals with their annotations.
#[derive(Debug, Clone, PartialEq)]
pub struct WfdbRecord {
    /// Content of the header file.
    pub header: WfdbHeader,
    /// Signals `[time, signals]` in physical units; NaN for invalid samples.
    pub signals: Timeseries,
    /// Annotations in order of time.
    pub annotations: Vec<WfdbAnnotation>,
}

/// Reads the header file of a record; the extension `.hea` of `path` is optional.
///
/// # Errors
/// `NotFound` or `Io` if it cannot be read; `Format` with the line number.
pub fn open_wfdb_header(path: impl AsRef<Path>) -> Result<WfdbHeader> {
    let path = header_path(path.as_ref());
    WfdbHeader::parse(&read_text(&path)?)
        .map_err(|(line, message)| Problem::at_line(&path, line, message).into())
}

/// Reads a record with the annotations beside it (`.atr`), if they exist.
///
/// # Errors
/// `NotFound` or `Io` if a file cannot be read; `Format` with file and line or byte; `Unsupported` for signal
/// formats other than 8, 16, 24, 32, 61, 80 and 212, and for records of several segments.
pub fn open_wfdb_record(path: impl AsRef<Path>) -> Result<WfdbRecord> {
    let path = header_path(path.as_ref());
    let header = open_wfdb_header(&path)?;
    let signals = read_signals(&path, &header)?;
    let annotations = read_annotations(&path, header.length)?;
    Ok(WfdbRecord { header, signals, annotations })
}

/// Returns the header file of a record, whose extension may be missing in `path`.
pub(super) fn header_path(path: &Path) -> PathBuf {
    if path.extension().is_some_and(|extension| extension == "hea") {
        return path.to_owned();
    }
    let mut name = path.as_os_str().to_owned();
    name.push(".hea");
    PathBuf::from(name)
}

/// Reads the signals of a record with this header file.
pub(super) fn read_signals(path: &Path, header: &WfdbHeader) -> Result<Timeseries> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let count = header.signals.len();
    let mut columns: Vec<Vec<f32>> = Vec::with_capacity(count);
    let mut first = 0;
    while let Some(signal) = header.signals.get(first) {
        // The signals of one file are consecutive.
        let shared = header.signals.iter().skip(first).take_while(|other| other.file == signal.file).count();
        let group = header.signals.get(first..first + shared).unwrap_or_default();
        let file = path_inside(folder, &signal.file)
            .map_err(|message| Problem::at_line(path, signal.line, message))?;
        let bytes = read_bytes(&file, MAX_BYTES)?;
        let (samples, length) = wfdb_samples(group, header.length, &bytes)
            .map_err(|(byte, message)| Error::from(Problem::at_byte(&file, byte, message)))?;
        if columns.first().is_some_and(|column| column.len() != length) {
            let message = format!(
                "has {length} samples, but the file before it has another number; the file is truncated"
            );
            return Err(Problem::new(file, message).into());
        }
        columns.extend(samples);
        first += shared;
    }
    let length = columns.first().map_or(0, Vec::len);
    let mut data = Vec::with_capacity(length * count);
    for time in 0..length {
        data.extend(columns.iter().filter_map(|column| column.get(time)));
    }
    Timeseries::new(data, [length, count])
}

/// Reads the annotations of a record of `length` samples, none if it has no file of them.
pub(super) fn read_annotations(path: &Path, length: Option<usize>) -> Result<Vec<WfdbAnnotation>> {
    let path = path.with_extension("atr");
    if !path.is_file() {
        return Ok(Vec::new());
    }
    let annotations = annotations_from_atr(&read_bytes(&path, MAX_BYTES)?)
        .map_err(|(byte, message)| Error::from(Problem::at_byte(&path, byte, message)))?;
    let outside = |annotation: &&WfdbAnnotation| {
        length.is_some_and(|length| annotation.sample < 0 || annotation.sample as u64 >= length as u64)
    };
    if let Some(annotation) = annotations.iter().find(outside) {
        let message =
            format!("has an annotation at sample {} of {}", annotation.sample, length.unwrap_or_default());
        return Err(Problem::new(path, message).into());
    }
    Ok(annotations)
}
