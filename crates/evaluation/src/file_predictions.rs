//! Predictions read from files, by sample.

use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use opendr_datasets::{Problem, Problems, open_for};
use opendr_engine::dataset::{DatasetIterator, ExternalDataset};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, ResultExt, Value, ValueType};
use opendr_metrics::MetricEntry;
use serde::Deserialize;
use serde_json::value::RawValue;

use crate::journal::PREDICTIONS_FORMAT;
use crate::predictor::empty_list;
use crate::sample_names::SampleNames;

/// Maximum length of a line.
const MAX_LINE: u64 = 1 << 30;

/// Predictions by the index of the sample in a data set.
pub enum FilePredictions {
    /// Lines of JSON as written by `opendr infer --json` and `opendr eval --out`, with the position of each sample's line.
    Lines(Lines),
    /// Annotations of a data set of any format, with the index of the annotation of each sample.
    Dataset(Box<dyn DatasetIterator>, Vec<Option<usize>>),
}

impl FilePredictions {
    /// Opens predictions for the samples of `dataset`: lines of JSON (`.jsonl`), or a data set of the format `format` whose annotations
    /// are of the type that `metric` compares.
    ///
    /// # Errors
    /// As [`Lines::open`] and [`open_for`].
    pub fn open(
        path: &Path,
        format: &str,
        metric: &MetricEntry,
        dataset: &dyn DatasetIterator,
        problems: &Problems,
    ) -> Result<Self> {
        if path.extension().is_some_and(|extension| extension == "jsonl") {
            return Ok(Self::Lines(Lines::open(path, dataset, problems)?));
        }
        let external = ExternalDataset::new(path, format);
        let predictions =
            open_for(&format!("{} compares", metric.name), &[metric.prediction], &external, None, problems)?;
        Ok(Self::from_dataset(predictions, dataset))
    }

    /// Uses the annotations of `predictions` as predictions for the samples of `dataset` of the same names.
    pub fn from_dataset(predictions: Box<dyn DatasetIterator>, dataset: &dyn DatasetIterator) -> Self {
        let names = SampleNames::of(dataset);
        let mut of_sample = vec![None; dataset.len()];
        for at in 0..predictions.len() {
            let found = names.find(&predictions.name(at));
            if let Some(position) = found.and_then(|sample| of_sample.get_mut(sample)) {
                *position = Some(at);
            }
        }
        Self::Dataset(predictions, of_sample)
    }

    /// Returns the classes of the predictions, if they are the same for all of them.
    pub fn classes(&self) -> Classes {
        match self {
            Self::Lines(_) => Classes::default(),
            Self::Dataset(predictions, _) => predictions.classes(),
        }
    }

    /// Returns the prediction for a sample, of the type `wanted`; an empty list when a file of detections has none for it.
    ///
    /// # Errors
    /// `InvalidInput` for a missing prediction that cannot be empty; `Format` for a line that is not a target.
    pub fn get(&self, at: usize, wanted: ValueType) -> Result<Value> {
        let prediction = match self {
            Self::Lines(lines) => lines.get(at, wanted)?,
            Self::Dataset(predictions, of_sample) => match of_sample.get(at).copied().flatten() {
                Some(index) => predictions.target(index)?,
                None => None,
            },
        };
        prediction
            .or_else(|| empty_list(wanted))
            .ok_or_else(|| Error::invalid_input("the sample has no prediction"))
    }
}

/// A file of JSON lines, of which only the positions are kept in memory.
pub struct Lines {
    path: PathBuf,
    file: Mutex<File>,
    /// Line number, first byte and length of each sample's line.
    positions: Vec<Option<(u64, u64, usize)>>,
}

/// A line of which only the names are parsed.
#[derive(Deserialize)]
struct Line<'a> {
    #[serde(alias = "opendr_eval")]
    format_version: Option<u64>,
    #[serde(alias = "input")]
    name: Option<String>,
    #[serde(default)]
    index: u64,
    #[serde(borrow)]
    outputs: Option<&'a RawValue>,
    #[serde(borrow)]
    prediction: Option<&'a RawValue>,
}

impl Lines {
    /// Indexes the lines of the samples of `dataset`.
    ///
    /// # Errors
    /// `Io`; `Unsupported` for a newer version of the format; `Format` for a line that is not JSON, unless `problems` skips it.
    pub fn open(path: &Path, dataset: &dyn DatasetIterator, problems: &Problems) -> Result<Self> {
        let context = || format!("opening {}", path.display());
        let file = File::open(path).context(context)?;
        let names = SampleNames::of(dataset);
        let mut positions = vec![None; dataset.len()];
        let mut reader = BufReader::new(&file);
        let (mut begin, mut text) = (0, Vec::new());
        for number in 1.. {
            text.clear();
            let length = (&mut reader).take(MAX_LINE).read_until(b'\n', &mut text).context(context)?;
            if length == 0 {
                break;
            }
            let line = serde_json::from_slice::<Line<'_>>(&text);
            if let Some(version) = line.as_ref().ok().and_then(|line| line.format_version) {
                PREDICTIONS_FORMAT.check_version(version).context(context)?;
            }
            match line {
                Ok(line) if line.outputs.is_some() || line.prediction.is_some() => {
                    let sample = line.name.as_deref().and_then(|name| match line.index {
                        0 => names.find(name),
                        frame => names.find(&format!("{name}/{frame}")),
                    });
                    if let Some(position) = sample.and_then(|sample| positions.get_mut(sample)) {
                        *position = Some((number, begin, length));
                    }
                }
                // A heading, or a sample that failed.
                Ok(_) => {}
                Err(error) => problems.report(Problem::at_line(path, number, error.to_string()))?,
            }
            begin += length as u64;
        }
        drop(reader);
        Ok(Self { path: path.to_owned(), file: Mutex::new(file), positions })
    }

    fn get(&self, at: usize, wanted: ValueType) -> Result<Option<Value>> {
        let Some((number, begin, length)) = self.positions.get(at).copied().flatten() else {
            return Ok(None);
        };
        let mut text = vec![0; length];
        {
            let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
            let read = file.seek(SeekFrom::Start(begin)).and_then(|_| file.read_exact(&mut text));
            read.context(|| format!("reading {}", self.path.display()))?;
        }
        self.value(&text, wanted)
            .map_err(|error| Problem::at_line(&self.path, number, error.to_string()).into())
    }

    fn value(&self, text: &[u8], wanted: ValueType) -> std::result::Result<Option<Value>, serde_json::Error> {
        let line: Line<'_> = serde_json::from_slice(text)?;
        if let Some(prediction) = line.prediction {
            return serde_json::from_str(prediction.get()).map(Some);
        }
        let Some(outputs) = line.outputs else { return Ok(None) };
        let outputs: std::collections::BTreeMap<String, Value> = serde_json::from_str(outputs.get())?;
        Ok(outputs.into_values().find(|value| value.as_value_ref().value_type() == wanted))
    }
}
