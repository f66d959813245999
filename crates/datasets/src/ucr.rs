//! Time series of the UCR and UEA archives: a series per line, as `.tsv`, `.csv` or `.txt`, or as `.ts` of sktime.

use std::collections::HashMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use opendr_engine::data::Timeseries;
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Error, Progress, Result, ResultExt, Value, ValueType};

use crate::folder::{files_in, name_of, past_end};
use crate::{Format, OpenOptions, Problem, Problems, Recognition, WriteOptions};

mod line;
mod write;

pub use line::{TsHeader, series_from_line, series_from_ts_line};

/// Largest length of a line in bytes: four million numbers of 16 characters.
const MAX_LINE_BYTES: u64 = 64 << 20;
const EXTENSIONS: &[&str] = &["ts", "tsv", "csv", "txt"];

/// Time series with their class: a sample is `[time, features]`.
///
/// Missing values are NaN. Those at the end are dropped, since UCR pads shorter series with them. Classes have the
/// order of the header of a `.ts` file, otherwise of their values.
#[derive(Debug)]
pub struct Ucr {
    path: PathBuf,
    header: Option<TsHeader>,
    lines: Vec<Line>,
    classes: Classes,
}

/// Location of a series in its file.
#[derive(Debug, Clone, Copy)]
struct Line {
    byte: u64,
    bytes: u64,
    number: u64,
    class: Option<u32>,
}

impl Ucr {
    /// Returns the file of the series.
    pub fn file(&self) -> &Path {
        &self.path
    }

    /// Returns the header of a `.ts` file.
    pub fn header(&self) -> Option<&TsHeader> {
        self.header.as_ref()
    }

    fn line(&self, index: usize) -> Result<Line> {
        self.lines.get(index).copied().ok_or_else(|| past_end(index, self.lines.len()))
    }

    fn series(&self, line: Line) -> Result<Timeseries> {
        let read = || {
            let mut file = File::open(&self.path)?;
            file.seek(SeekFrom::Start(line.byte))?;
            let mut bytes = Vec::new();
            file.take(line.bytes).read_to_end(&mut bytes)?;
            Ok::<_, Error>(bytes)
        };
        let bytes = read().context(|| format!("reading {}", self.path.display()))?;
        let text = String::from_utf8_lossy(&bytes);
        let series = match &self.header {
            Some(header) => series_from_ts_line(&text, header),
            None => series_from_line(&text).map(|(_, series)| series),
        };
        series.map_err(|message| Problem::at_line(&self.path, line.number, message).into())
    }
}

impl Dataset for Ucr {}

impl DatasetIterator for Ucr {
    fn len(&self) -> usize {
        self.lines.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let series = self.series(self.line(index)?)?;
        Ok(Sample { data: vec![Value::Timeseries(series)], target: self.target(index)? })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        let Some(class) = self.line(index)?.class.map(i64::from) else { return Ok(None) };
        let description = self.classes.name(class).cloned();
        Ok(Some(Value::Category(Category { description, ..Category::new(class, Some(1.0)) })))
    }

    fn name(&self, index: usize) -> String {
        match self.line(index) {
            Ok(line) => format!("{}:{}", name_of(&self.path), line.number),
            Err(_) => index.to_string(),
        }
    }

    fn path(&self, _index: usize) -> Option<PathBuf> {
        Some(self.path.clone())
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }
}

impl Format for Ucr {
    const NAME: &'static str = "ucr";
    const ALIASES: &'static [&'static str] = &["uea", "sktime", "aeon"];
    const ABOUT: &'static str = "time series of the UCR and UEA archives";
    const LAYOUT: &'static str = "NAME_TRAIN and NAME_TEST as .ts, .tsv, .csv or .txt, the class first (last in .ts); or one such file";
    const TARGETS: &'static [ValueType] = &[ValueType::Category];

    fn recognise(path: &Path) -> Recognition {
        let files = candidates(path);
        let is_ts = |file: &PathBuf| file.extension().is_some_and(|extension| extension == "ts");
        let Some(file) = files.iter().find(|file| is_ts(file)).or(files.first()) else {
            return Recognition::No("a .ts file, or NAME_TRAIN or NAME_TEST as .tsv, .csv or .txt".into());
        };
        let mut head = Vec::new();
        let read = File::open(file).and_then(|file| file.take(1 << 16).read_to_end(&mut head));
        let head = String::from_utf8_lossy(&head);
        let first =
            head.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or_default();
        if read.is_ok() && is_ts(file) && first.trim_start().starts_with('@') {
            return Recognition::Certain;
        }
        // A truncated line ends in a truncated number, which still parses.
        match !is_ts(file) && line::looks_like_series(first) {
            true => Recognition::Possible,
            false => Recognition::No(format!(
                "a line of numbers between tabs, commas or blanks in {}",
                file.display()
            )),
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let files = candidates(path);
        let part_of = |file: &PathBuf| name_of(file).to_lowercase();
        let with = |part: &str| files.iter().find(|file| part_of(file).contains(&format!("_{part}.")));
        let selected = match options.split.as_deref() {
            Some(part) => with(&part.to_lowercase()),
            None => with("test").or_else(|| with("train")).or(files.first()),
        };
        let file = selected.ok_or_else(|| {
            let there: Vec<_> = files.iter().map(|file| name_of(file)).collect();
            let (path, layout) = (path.display(), Self::LAYOUT);
            let message =
                format!("no such series in {path} (files: {}); the layout is {layout}", there.join(", "));
            Error::not_found(message)
        })?;
        Self::index(file, problems)
    }

    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        write::write(dataset, path, options, problems, progress)
    }
}

/// Returns the files that may contain series: `path` itself, or those in it with a usual name.
fn candidates(path: &Path) -> Vec<PathBuf> {
    if !path.is_dir() {
        let fits = path.to_str().is_some_and(|name| crate::folder::has_extension(name, EXTENSIONS));
        return if fits && path.is_file() { vec![path.to_owned()] } else { Vec::new() };
    }
    let has_usual_name = |name: &String| {
        let stem = name.rsplit_once('.').map_or("", |(stem, _)| stem).to_uppercase();
        name.ends_with(".ts") || stem.ends_with("_TRAIN") || stem.ends_with("_TEST")
    };
    let mut names = files_in(path, EXTENSIONS);
    names.retain(has_usual_name);
    // Of a series in several formats, the one with the most information comes first.
    names.sort_by_key(|name| EXTENSIONS.iter().position(|extension| name.ends_with(extension)));
    names.into_iter().map(|name| path.join(name)).collect()
}

impl Ucr {
    /// Reads the offsets of the lines of a file and their classes, without parsing the values.
    fn index(path: &Path, problems: &Problems) -> Result<Self> {
        let mut reader = BufReader::new(File::open(path).context(|| format!("opening {}", path.display()))?);
        let is_ts = path.extension().is_some_and(|extension| extension == "ts");
        let mut header = is_ts.then(TsHeader::default);
        let mut in_data = !is_ts;
        let (mut lines, mut labels) = (Vec::new(), HashMap::<String, u32>::new());
        let (mut byte, mut number, mut bytes) = (0u64, 0u64, Vec::new());
        loop {
            bytes.clear();
            let read = reader.by_ref().take(MAX_LINE_BYTES).read_until(b'\n', &mut bytes);
            let read = read.context(|| format!("reading {}", path.display()))? as u64;
            if read == 0 {
                break;
            }
            number += 1;
            let start = byte;
            byte += read;
            if read == MAX_LINE_BYTES {
                return Err(Problem::at_line(path, number, format!("is over {MAX_LINE_BYTES} bytes")).into());
            }
            let Ok(text) = std::str::from_utf8(&bytes) else {
                problems.report(Problem::at_line(path, number, "is not UTF-8 text"))?;
                continue;
            };
            let text = text.trim();
            if text.is_empty() || (is_ts && text.starts_with(['#', '%'])) {
                continue;
            }
            if let Some(header) = header.as_mut().filter(|_| !in_data) {
                in_data = text.eq_ignore_ascii_case("@data");
                if let Err(message) = header.take(text) {
                    problems.report(Problem::at_line(path, number, message))?;
                }
                continue;
            }
            match line::label(text, header.as_ref()) {
                Ok(label) => {
                    // Index of the label in the order of appearance, until all labels are known.
                    let next = labels.len() as u32;
                    let class = label.map(|label| *labels.entry(label).or_insert(next));
                    lines.push(Line { byte: start, bytes: read, number, class });
                }
                Err(message) => problems.report(Problem::at_line(path, number, message))?,
            }
        }
        if !in_data {
            return Err(Problem::new(path, "has no line @data; the file is truncated").into());
        }
        let classes = line::classes(labels.keys().map(String::as_str), header.as_ref());
        let number: HashMap<&str, u32> = classes.iter().zip(0..).collect();
        let mut classes_of = vec![None; labels.len()];
        for (label, place) in &labels {
            classes_of[*place as usize] = number.get(label.as_str()).copied();
        }
        for line in &mut lines {
            line.class = line.class.and_then(|place| classes_of.get(place as usize).copied().flatten());
        }
        Ok(Self { path: path.to_owned(), header, lines, classes })
    }
}

/// Runs the parsers of headers and lines, for the fuzzers.
pub(crate) fn parse_any(text: &str) {
    let mut header = TsHeader::default();
    for line in text.lines() {
        let _ = header.take(line);
        let _ = (line::label(line, Some(&header)), line::label(line, None), line::looks_like_series(line));
        let _ = (series_from_ts_line(line, &header), series_from_line(line));
    }
}

#[cfg(test)]
mod tests;
