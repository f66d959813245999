//! The journal: the predictions of an evaluation on disk, from which it resumes.
//!
//! The first line describes the evaluation; each further line is the JSON of a sample, in order. An incomplete last line, left by a
//! killed process, is dropped.

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use opendr_datasets::Problem;
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::{Error, JsonFormat, Result, ResultExt, Value};
use serde::{Deserialize, Serialize};

use crate::Subject;

/// Format of files of predictions. A journal has the version in its first line, `opendr infer --json` in each. Version 2 renamed
/// `opendr_eval` to `format_version`, and `place` of a problem to `location`.
pub const PREDICTIONS_FORMAT: JsonFormat =
    JsonFormat::new("file of predictions", 2).with_former_key("opendr_eval");

/// The first line.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct Heading {
    #[serde(flatten)]
    subject: Subject,
    dataset: String,
    samples: usize,
    /// Hash of the names of the samples.
    fingerprint: String,
}

impl Heading {
    pub fn new(subject: Subject, dataset: String, samples: &dyn DatasetIterator) -> Self {
        let names = (0..samples.len()).map(|at| samples.name(at));
        Self::of_names(subject, dataset, names)
    }

    fn of_names(subject: Subject, dataset: String, names: impl ExactSizeIterator<Item = String>) -> Self {
        let samples = names.len();
        Self { subject, dataset, samples, fingerprint: fingerprint(names) }
    }
}

/// FNV-1a hash of the names, to distinguish data sets; it need not resist forgery.
fn fingerprint(names: impl Iterator<Item = String>) -> String {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for name in names {
        for byte in name.bytes().chain([0]) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
    format!("{hash:016x}")
}

/// The result of one sample.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Line {
    pub at: usize,
    pub name: String,
    #[serde(flatten)]
    pub result: SampleResult,
}

/// A prediction, or why there is none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SampleResult {
    Prediction(Box<Value>),
    Error(Problem),
}

impl SampleResult {
    /// Converts the result for the sample `at`.
    pub fn of(result: Result<Value>, dataset: &dyn DatasetIterator, at: usize) -> Self {
        match result {
            Ok(value) => Self::Prediction(Box::new(value)),
            Err(error) => Self::Error(Problem::of(&error, dataset, at)),
        }
    }
}

/// A journal open for writing.
pub struct Journal {
    path: PathBuf,
    file: File,
}

impl Journal {
    /// Opens or creates the journal at `path` and passes every sample in it to `each`, in order. The first sample for which `each`
    /// returns `false` and all later ones are dropped.
    ///
    /// # Errors
    /// `InvalidInput` when the journal belongs to another evaluation; `Format` when it is not a journal; `Io`.
    pub fn open(path: &Path, heading: &Heading, mut each: impl FnMut(Line) -> Result<bool>) -> Result<Self> {
        let context = || format!("opening {}", path.display());
        let mut file = OpenOptions::new().read(true).append(true).create(true).open(path).context(context)?;
        let mut reader = BufReader::new(&file);
        let mut first = String::new();
        reader.read_line(&mut first).context(context)?;
        if !first.ends_with('\n') {
            file.set_len(0).context(context)?;
            let mut journal = Self { path: path.to_owned(), file };
            journal.append(PREDICTIONS_FORMAT.to_json(heading)? + "\n")?;
            return Ok(journal);
        }
        check_heading(path, &first, heading)?;
        let mut end = first.len() as u64;
        let mut text = String::new();
        for at in 0.. {
            text.clear();
            reader.read_line(&mut text).context(context)?;
            let line = serde_json::from_str::<Line>(&text).ok().filter(|line| line.at == at);
            let Some(line) = line.filter(|_| text.ends_with('\n')) else { break };
            if !each(line)? {
                break;
            }
            end += text.len() as u64;
        }
        file.set_len(end).context(context)?;
        file.seek(SeekFrom::End(0)).context(context)?;
        Ok(Self { path: path.to_owned(), file })
    }

    /// Opens the journal of predictions for the samples of `dataset` and passes its samples to `each`. An incomplete sequence is
    /// dropped, since a learner with state needs it from its first frame.
    ///
    /// # Errors
    /// As [`Journal::open`], and the errors of `each`.
    pub fn resume(
        path: &Path,
        heading: &Heading,
        dataset: &dyn DatasetIterator,
        mut each: impl FnMut(Line) -> Result<()>,
    ) -> Result<Self> {
        let mut whole = dataset.len();
        if !dataset.is_empty() && dataset.sequence(0).is_some() {
            let mut lines = 0;
            Self::open(path, heading, |_| {
                lines += 1;
                Ok(true)
            })?;
            whole = whole_sequences(dataset, lines);
        }
        Self::open(path, heading, |line| match line.at < whole {
            true => each(line).map(|()| true),
            false => Ok(false),
        })
    }

    /// Appends a line.
    ///
    /// # Errors
    /// `Io` when the disk is full.
    pub fn write(&mut self, line: &impl Serialize) -> Result<()> {
        self.append(json_line(line)?)
    }

    fn append(&mut self, text: String) -> Result<()> {
        self.file.write_all(text.as_bytes()).context(|| format!("writing {}", self.path.display()))
    }
}

/// Returns the JSON of a sample as a line.
pub fn json_line(line: &impl Serialize) -> Result<String> {
    let text = serde_json::to_string(line)
        .map_err(|error| Error::internal("a prediction cannot be written as JSON").with_source(error))?;
    Ok(text + "\n")
}

/// Returns how many of the first `count` samples belong to complete sequences.
fn whole_sequences(dataset: &dyn DatasetIterator, count: usize) -> usize {
    let over = |at: usize| at == 0 || at >= dataset.len() || dataset.sequence(at) != dataset.sequence(at - 1);
    (0..=count.min(dataset.len())).rev().find(|at| over(*at)).unwrap_or(0)
}

fn check_heading(path: &Path, text: &str, heading: &Heading) -> Result<()> {
    let path = path.display();
    let found: Heading =
        PREDICTIONS_FORMAT.read(text.as_bytes()).context(|| format!("opening {path}; use another folder"))?;
    if found == *heading {
        return Ok(());
    }
    let differs = [
        ("learner", found.subject.learner != heading.subject.learner),
        ("model", found.subject.model != heading.subject.model),
        ("parameters", found.subject.params != heading.subject.params),
        ("data set", found.dataset != heading.dataset || found.fingerprint != heading.fingerprint),
    ];
    let differs: Vec<_> = differs.iter().filter(|(_, differs)| *differs).map(|(what, _)| *what).collect();
    Err(Error::invalid_input(format!(
        "{path} belongs to another evaluation ({} differs); use another folder, or delete it to start again",
        differs.join(", ")
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_engine::target::Category;

    fn heading(learner: &str) -> Heading {
        let subject = Subject { learner: learner.to_owned(), ..Subject::default() };
        Heading::of_names(subject, "data".to_owned(), ["a".to_owned(), "b".to_owned()].into_iter())
    }

    fn line(at: usize) -> Line {
        let result = SampleResult::Prediction(Box::new(Category::new(at as i64, None).into()));
        Line { at, name: at.to_string(), result }
    }

    fn read(path: &Path, heading: &Heading) -> Result<(Vec<Line>, Journal)> {
        let mut lines = Vec::new();
        let journal = Journal::open(path, heading, |line| {
            lines.push(line);
            Ok(true)
        })?;
        Ok((lines, journal))
    }

    #[test]
    fn resumes_after_an_incomplete_line() {
        let folder = std::env::temp_dir().join(format!("opendr-journal-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("predictions.jsonl");
        let (none, mut journal) = read(&path, &heading("a")).unwrap();
        assert!(none.is_empty());
        let failed = Line {
            at: 1,
            name: "1".to_owned(),
            result: SampleResult::Error(Problem::new("1.jpg", "broken")),
        };
        journal.write(&line(0)).unwrap();
        journal.write(&failed).unwrap();
        journal.file.write_all(b"{\"at\":2,\"name\":\"2\",\"predic").unwrap();
        drop(journal);
        let (lines, mut journal) = read(&path, &heading("a")).unwrap();
        assert_eq!(lines, [line(0), failed.clone()]);
        journal.write(&line(2)).unwrap();
        drop(journal);
        assert_eq!(read(&path, &heading("a")).unwrap().0, [line(0), failed, line(2)]);
        let error = read(&path, &heading("b")).err().unwrap();
        assert!(error.to_string().contains("(learner differs)"), "{error}");
        std::fs::write(&path, "{\"format_version\": 3}\n").unwrap();
        let error = read(&path, &heading("a")).err().unwrap();
        assert!(
            error.to_string().contains("format version 3") && error.to_string().contains("update OpenDR"),
            "{error}"
        );
        std::fs::write(&path, "nonsense\n").unwrap();
        assert!(read(&path, &heading("a")).is_err());
        std::fs::remove_dir_all(folder).unwrap();
    }

    /// `tests/formats/version_1` has the file and the command that wrote it.
    #[test]
    fn a_journal_of_version_1_is_resumed() {
        let folder = std::env::temp_dir().join(format!("opendr-journal-1-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("predictions.jsonl");
        std::fs::write(&path, include_bytes!("../../../tests/formats/version_1/eval/predictions.jsonl"))
            .unwrap();
        let subject = Subject {
            learner: "gated_recurrent_unit".to_owned(),
            model: Some("gru/model".to_owned()),
            ..Subject::default()
        };
        let names = (1..13).map(|number| format!("waves_TEST.tsv:{number}"));
        let heading = Heading::of_names(subject, "waves".to_owned(), names);
        let (lines, _) = read(&path, &heading).unwrap();
        assert_eq!(lines.len(), 12);
        let SampleResult::Error(problem) = &lines[7].result else { panic!("{:?}", lines[7]) };
        assert!(problem.location.is_some());
        std::fs::remove_dir_all(folder).unwrap();
    }
}
