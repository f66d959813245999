//! Writer of time series as WFDB records.

use std::fmt::Write as _;
use std::path::Path;

use opendr_engine::data::Timeseries;
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::{Error, Progress, Result, Value};

use crate::Problems;
use crate::folder::{path_inside, write_file};
use crate::picture_files::write_each;
use crate::wfdb::{WfdbAnnotation, WfdbRecord, atr_from_annotations, wfdb_from_timeseries};

/// Sampling frequency of series, which do not state one, in Hz.
const FREQUENCY: f64 = 1.0;

/// Writes a record for each sample, named by its index, and their list `RECORDS`.
pub(super) fn write(
    dataset: &dyn DatasetIterator,
    path: &Path,
    problems: &Problems,
    progress: &dyn Progress,
) -> Result<()> {
    let mut list = String::new();
    write_each(dataset, problems, progress, |index| {
        let name = format!("{index:06}");
        let sample = dataset.get(index)?;
        let Some(Value::Timeseries(series)) = sample.data.first() else {
            return Err(Error::invalid_input("the sample has no time series, which WFDB needs"));
        };
        write_files(path, &name, series, FREQUENCY, &[])?;
        list += &format!("{name}\n");
        Ok(())
    })?;
    write_file(&path.join("RECORDS"), list.as_bytes())
}

impl WfdbRecord {
    /// Writes the record into `folder` as `NAME.hea`, `NAME.dat` (format 16) and, with annotations, `NAME.atr`.
    ///
    /// # Errors
    /// `InvalidInput` for an invalid name, or annotations out of order; `Io`.
    pub fn save(&self, folder: impl AsRef<Path>) -> Result<()> {
        let header = &self.header;
        write_files(folder.as_ref(), &header.name, &self.signals, header.frequency, &self.annotations)?;
        let descriptions =
            header.signals.iter().map(|signal| (signal.units.as_str(), signal.description.as_str()));
        let text = header_text(&header.name, &self.signals, header.frequency, descriptions)?;
        write_file(&folder.as_ref().join(format!("{}.hea", header.name)), text.as_bytes())
    }
}

fn write_files(
    folder: &Path,
    name: &str,
    series: &Timeseries,
    frequency: f64,
    annotations: &[WfdbAnnotation],
) -> Result<()> {
    let stem = path_inside(folder, name).map_err(Error::invalid_input)?;
    let [_, signals] = series.shape();
    let (bytes, _) = wfdb_from_timeseries(series.as_slice(), signals);
    let header = header_text(name, series, frequency, std::iter::repeat(("NU", "")))?;
    write_file(&stem.with_extension("dat"), &bytes)?;
    write_file(&stem.with_extension("hea"), header.as_bytes())?;
    if annotations.is_empty() {
        return Ok(());
    }
    write_file(&stem.with_extension("atr"), &atr_from_annotations(annotations)?)
}

fn header_text<'a>(
    name: &str,
    series: &Timeseries,
    frequency: f64,
    described: impl Iterator<Item = (&'a str, &'a str)>,
) -> Result<String> {
    let plain =
        |text: &str| text.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_' || byte == b'-');
    if name.is_empty() || !plain(name) {
        return Err(Error::invalid_input(format!(
            "{name:.40?} is not a valid name of a record; use letters, digits, _ and -"
        )));
    }
    let [length, signals] = series.shape();
    let (_, parameters) = wfdb_from_timeseries(series.as_slice(), signals);
    let mut text = format!("{name} {signals} {frequency} {length}\n");
    for ((at, (gain, baseline, sum)), (units, description)) in
        parameters.into_iter().enumerate().zip(described)
    {
        let first = series.as_slice().get(at).copied().unwrap_or(0.0);
        let first =
            if first.is_finite() { (f64::from(first) * gain).round() as i64 + baseline } else { -32768 };
        let sum = sum as i16;
        let description =
            if description.is_empty() { format!("signal {at}") } else { description.to_owned() };
        // Writing to a String cannot fail.
        writeln!(text, "{name}.dat 16 {gain}({baseline})/{units} 16 0 {first} {sum} 0 {description}").ok();
    }
    Ok(text)
}
