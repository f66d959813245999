//! Answers that somebody wrote into files, by sample.

use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use opendr_datasets::{Problem, Problems};
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, ResultExt, Value, ValueType};
use serde::Deserialize;
use serde_json::value::RawValue;

use crate::predictor::nothing_of;
use crate::sample_names::SampleNames;

/// Longer lines are no answer.
const MAX_LINE: u64 = 1 << 30;

/// Answers by the number of the sample in a data set.
pub enum Answers {
    /// Lines of JSON, as `opendr infer --json` and `opendr eval --out` write them; where each sample's line lies.
    Lines(Lines),
    /// The annotations of a data set of any format; which of its samples answers.
    Dataset(Box<dyn DatasetIterator>, Vec<Option<usize>>),
}

impl Answers {
    /// The annotations of `answers` for the samples of `dataset`, by their names.
    pub fn from_dataset(answers: Box<dyn DatasetIterator>, dataset: &dyn DatasetIterator) -> Self {
        let names = SampleNames::of(dataset);
        let mut of_sample = vec![None; dataset.len()];
        for at in 0..answers.len() {
            let found = names.find(&answers.name(at));
            if let Some(place) = found.and_then(|sample| of_sample.get_mut(sample)) {
                *place = Some(at);
            }
        }
        Self::Dataset(answers, of_sample)
    }

    /// What class numbers mean, where the answers say it for all of them.
    pub fn classes(&self) -> Classes {
        match self {
            Self::Lines(_) => Classes::default(),
            Self::Dataset(answers, _) => answers.classes(),
        }
    }

    /// What is answered to a sample, as `wanted`; nothing found when a file of objects says nothing of it.
    ///
    /// # Errors
    /// `InvalidInput` when there must be an answer and is none; `Format` for a line that is no target.
    pub fn get(&self, at: usize, wanted: ValueType) -> Result<Value> {
        let answer = match self {
            Self::Lines(lines) => lines.get(at, wanted)?,
            Self::Dataset(answers, of_sample) => match of_sample.get(at).copied().flatten() {
                Some(index) => answers.target(index)?,
                None => None,
            },
        };
        answer.or_else(|| nothing_of(wanted)).ok_or_else(|| Error::invalid_input("it is not answered"))
    }
}

/// A file of lines of JSON, of which only the places are kept.
pub struct Lines {
    path: PathBuf,
    file: Mutex<File>,
    /// Number, first byte and length of each sample's line.
    places: Vec<Option<(u64, u64, usize)>>,
}

/// A line, of which only the name is looked at.
#[derive(Deserialize)]
struct Line<'a> {
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
    /// Reads where the answers to the samples of `dataset` lie.
    ///
    /// # Errors
    /// `Io`; `Format` for a line that is no JSON, unless `problems` skips it.
    pub fn open(path: &Path, dataset: &dyn DatasetIterator, problems: &Problems) -> Result<Self> {
        let context = || format!("opening {}", path.display());
        let file = File::open(path).context(context)?;
        let names = SampleNames::of(dataset);
        let mut places = vec![None; dataset.len()];
        let mut reader = BufReader::new(&file);
        let (mut begin, mut text) = (0, Vec::new());
        for number in 1.. {
            text.clear();
            let length = (&mut reader).take(MAX_LINE).read_until(b'\n', &mut text).context(context)?;
            if length == 0 {
                break;
            }
            match serde_json::from_slice::<Line<'_>>(&text) {
                Ok(line) if line.outputs.is_some() || line.prediction.is_some() => {
                    let sample = line.name.as_deref().and_then(|name| match line.index {
                        0 => names.find(name),
                        frame => names.find(&format!("{name}/{frame}")),
                    });
                    if let Some(place) = sample.and_then(|sample| places.get_mut(sample)) {
                        *place = Some((number, begin, length));
                    }
                }
                // A heading, or a failure.
                Ok(_) => {}
                Err(error) => problems.report(Problem::at_line(path, number, error.to_string()))?,
            }
            begin += length as u64;
        }
        drop(reader);
        Ok(Self { path: path.to_owned(), file: Mutex::new(file), places })
    }

    fn get(&self, at: usize, wanted: ValueType) -> Result<Option<Value>> {
        let Some((number, begin, length)) = self.places.get(at).copied().flatten() else { return Ok(None) };
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
