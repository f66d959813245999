//! WFDB records of PhysioNet: biomedical signals with annotated beats.
//!
//! Format: <https://physionet.org/physiotools/wag/>, sections header(5), signal(5), annot(5).

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use opendr_engine::data::Timeseries;
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Header, Progress, Result, Value, ValueType};

use crate::fields::lines;
use crate::folder::{files_in, past_end, path_inside, read_text};
use crate::{Format, OpenOptions, Problem, Problems, Recognition, WriteOptions};

mod annotation;
mod beats;
mod header;
mod record;
mod signal;
mod write;

pub use annotation::{WfdbAnnotation, annotations_from_atr, atr_from_annotations};
pub use header::{WfdbHeader, WfdbSignal};
pub use record::{WfdbRecord, open_wfdb_header, open_wfdb_record};
pub use signal::{wfdb_from_timeseries, wfdb_samples};

use beats::Beats;
use record::{header_path, read_annotations, read_signals};

/// Number of records in the cache, if samples are beats.
const MAX_CACHED: usize = 4;

/// A record in the cache.
type ReadRecord = Arc<(WfdbHeader, Timeseries)>;

/// WFDB records: a sample is a whole record without target, or, if beats are annotated and the target is a
/// `Category` (the default), one beat with its class of AAMI EC57 (N, S, V, F, Q).
///
/// A beat extends from a quarter of a second before its annotation to half a second after it; beats too close to
/// the ends of their record are skipped.
#[derive(Debug)]
pub struct Wfdb {
    records: Vec<PathBuf>,
    beats: Option<Beats>,
    /// Cache of the records used last.
    kept: Mutex<Vec<(usize, ReadRecord)>>,
}

impl Wfdb {
    /// Returns the header files of the records.
    pub fn records(&self) -> &[PathBuf] {
        &self.records
    }

    /// Returns record `record`, and keeps it in the cache for the next beat.
    fn record(&self, record: usize) -> Result<ReadRecord> {
        let lock = || self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, cached)) = lock().iter().find(|(number, _)| *number == record) {
            return Ok(Arc::clone(cached));
        }
        let path = self.records.get(record).ok_or_else(|| past_end(record, self.records.len()))?;
        let header = open_wfdb_header(path)?;
        let signals = read_signals(path, &header)?;
        let read = Arc::new((header, signals));
        let mut kept = lock();
        kept.truncate(MAX_CACHED - 1);
        kept.insert(0, (record, Arc::clone(&read)));
        Ok(read)
    }

    /// Returns the record and the annotation of beat `index`; `None` if samples are records.
    fn beat(&self, index: usize) -> Option<(usize, beats::Beat)> {
        self.beats.as_ref()?.get(index)
    }
}

impl Dataset for Wfdb {}

impl DatasetIterator for Wfdb {
    fn len(&self) -> usize {
        self.beats.as_ref().map_or(self.records.len(), Beats::len)
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let beat = match &self.beats {
            Some(beats) => Some(beats.get(index).ok_or_else(|| past_end(index, self.len()))?),
            None => None,
        };
        let record = self.record(beat.map_or(index, |(record, _)| record))?;
        let (header, signals) = &*record;
        let signals = match beat {
            Some((_, beat)) => beats::cut(signals, header, beat.sample)?,
            None => signals.clone(),
        };
        let datum =
            signals.with_header(Header { frame_id: Some(header.name.as_str().into()), stamp_ns: None });
        Ok(Sample { data: vec![Value::Timeseries(datum)], target: self.target(index)? })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        Ok(self.beat(index).map(|(_, beat)| Value::Category(beat.category())))
    }

    fn name(&self, index: usize) -> String {
        let stem = |path: &PathBuf| path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let named = match self.beat(index) {
            Some((record, beat)) => {
                self.records.get(record).and_then(stem).map(|stem| format!("{stem}/{}", beat.sample))
            }
            None => self.records.get(index).and_then(stem),
        };
        named.unwrap_or_else(|| index.to_string())
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        let record = if self.beats.is_some() { self.beat(index)?.0 } else { index };
        self.records.get(record).cloned()
    }

    fn classes(&self) -> Classes {
        if self.beats.is_some() { beats::classes() } else { Classes::default() }
    }
}

impl Format for Wfdb {
    const NAME: &'static str = "wfdb";
    const ALIASES: &'static [&'static str] = &["physionet", "mitdb"];
    const ABOUT: &'static str = "WFDB records of PhysioNet: signals with annotated beats";
    const LAYOUT: &'static str =
        "RECORD.hea with its RECORD.dat and, if beats are annotated, RECORD.atr; RECORDS may list them";
    const TARGETS: &'static [ValueType] = &[ValueType::Category];

    fn recognise(path: &Path) -> Recognition {
        let is_header = path.extension().is_some_and(|extension| extension == "hea") && path.is_file();
        match is_header || header_path(path).is_file() || !files_in(path, &["hea"]).is_empty() {
            true => Recognition::Certain,
            false => Recognition::No("a .hea file".into()),
        }
    }

    /// Opens records; `split` is the name of a list of records, instead of `RECORDS`.
    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let mut records = list(path, options.split.as_deref(), problems)?;
        let mut known = Vec::with_capacity(records.len());
        for record in &records {
            let header = open_wfdb_header(record);
            match header.and_then(|header| Ok((read_annotations(record, header.length)?, header))) {
                Ok((annotations, header)) => known.push(Some((annotations, header))),
                Err(error) => {
                    let problem =
                        std::error::Error::source(&error).and_then(|source| source.downcast_ref::<Problem>());
                    let problem = problem.cloned();
                    problems.report(problem.unwrap_or_else(|| Problem::new(record, error.to_string())))?;
                    known.push(None);
                }
            }
        }
        let mut whole = known.iter().map(Option::is_some);
        records.retain(|_| whole.next().unwrap_or(false));
        if records.is_empty() {
            let (path, layout) = (path.display(), Self::LAYOUT);
            return Err(Error::not_found(format!("no WFDB record in {path}; the layout is {layout}")));
        }
        Ok(Self { records, beats: Beats::of(known.into_iter().flatten()), kept: Mutex::default() })
    }

    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        _options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        write::write(dataset, path, problems, progress)
    }
}

/// Returns the header files at `path`: itself, those of the list, or all in the folder.
fn list(path: &Path, part: Option<&str>, problems: &Problems) -> Result<Vec<PathBuf>> {
    if !path.is_dir() {
        return Ok(vec![header_path(path)]);
    }
    let list = path_inside(path, part.unwrap_or("RECORDS")).map_err(Error::invalid_param)?;
    if part.is_none() && !list.is_file() {
        return Ok(files_in(path, &["hea"]).into_iter().map(|name| path.join(name)).collect());
    }
    let mut records = Vec::new();
    for (number, line) in lines(&read_text(&list)?) {
        match path_inside(path, line.trim()) {
            Ok(record) => records.push(header_path(&record)),
            Err(message) => problems.report(Problem::at_line(&list, number, message))?,
        }
    }
    Ok(records)
}

#[cfg(test)]
mod tests;
