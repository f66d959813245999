//! Report of each frame's predictions: text for people, lines of JSON for programs (`docs/command-line.md`).

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use opendr::evaluation::PREDICTIONS_FORMAT;
use opendr::learner::Outputs;
use opendr::{Error, Result, ResultExt, Value};
use serde::Serialize;

use crate::item::Item;
use crate::progress_bar::ProgressBar;
use crate::stdout;
use crate::timings::Timings;

/// A line of JSON.
#[derive(Serialize)]
struct Line<'a> {
    /// File or device; absent for an error without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    input: Option<&'a str>,
    /// Index of the frame within its input.
    #[serde(skip_serializing_if = "Option::is_none")]
    index: Option<u64>,
    /// Outputs of the learner by name.
    #[serde(skip_serializing_if = "Option::is_none")]
    outputs: Option<BTreeMap<&'static str, &'a Value>>,
    /// Error, if there are no outputs.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<Failure>,
    /// Duration of the stages.
    #[serde(skip_serializing_if = "Option::is_none")]
    timings_ms: Option<Timings>,
}

/// An error in a line of JSON.
#[derive(Serialize)]
struct Failure {
    kind: &'static str,
    message: String,
}

/// Destination of the lines of JSON.
pub enum Json {
    /// No JSON; text on standard output.
    Off,
    /// Standard output, instead of text.
    Stdout,
    /// A file, besides text on standard output.
    File(PathBuf, BufWriter<File>),
}

impl Json {
    /// Creates the file `path`, or empties an existing one.
    ///
    /// # Errors
    /// `Io` when the file cannot be created.
    pub fn file(path: &Path) -> Result<Self> {
        let file = File::create(path).context(|| format!("creating {}", path.display()))?;
        Ok(Self::File(path.to_owned(), BufWriter::new(file)))
    }
}

/// Report of frames in the order of processing.
pub struct Report<'a> {
    bar: &'a ProgressBar,
    json: Json,
    timings: bool,
    failures: u64,
}

impl<'a> Report<'a> {
    /// Creates a report that prints around `bar`; `timings` adds the duration of the stages.
    pub fn new(bar: &'a ProgressBar, json: Json, timings: bool) -> Self {
        Self { bar, json, timings, failures: 0 }
    }

    /// Reports the outputs of a frame or file.
    ///
    /// # Errors
    /// `Io` when it cannot be written.
    pub fn item(&mut self, item: &Item, outputs: &Outputs, timings: Timings) -> Result<()> {
        let input = item.path().to_string_lossy();
        let timings_ms = self.timings.then_some(timings);
        if !matches!(self.json, Json::Stdout) {
            let name = match item.is_of_stream() {
                true => format!("{input} frame {}", item.number()),
                false => input.to_string(),
            };
            let text = text(&name, outputs, timings_ms);
            self.bar.suspend(|| stdout::print(text))?;
        }
        let outputs = Some(outputs.iter().collect());
        self.line(&Line { input: Some(&input), index: Some(item.number()), outputs, error: None, timings_ms })
    }

    /// Reports an error of one input.
    ///
    /// # Errors
    /// `Io` when it cannot be written.
    pub fn failure(&mut self, input: Option<&Path>, error: &Error) -> Result<()> {
        self.failures += 1;
        let input = input.map(Path::to_string_lossy);
        let input = input.as_deref();
        self.bar.suspend(|| eprintln!("error: {error}"));
        let error = Some(Failure { kind: error.kind().name(), message: error.to_string() });
        self.line(&Line { input, index: None, outputs: None, error, timings_ms: None })
    }

    /// Ends the report and returns the number of errors.
    ///
    /// # Errors
    /// `Io` when the rest of the file cannot be written.
    pub fn finish(mut self) -> Result<u64> {
        if let Json::File(path, file) = &mut self.json {
            file.flush().context(|| format!("writing {}", path.display()))?;
        }
        Ok(self.failures)
    }

    fn line(&mut self, line: &Line<'_>) -> Result<()> {
        if matches!(self.json, Json::Off) {
            return Ok(());
        }
        let text = PREDICTIONS_FORMAT.to_json(line)?;
        match &mut self.json {
            Json::Off => Ok(()),
            Json::Stdout => self.bar.suspend(|| stdout::print(text)),
            Json::File(path, file) => {
                writeln!(file, "{text}").context(|| format!("writing {}", path.display()))
            }
        }
    }
}

/// Formats the outputs as text, indented under `name`.
pub fn text(name: &str, outputs: &Outputs, timings: Option<Timings>) -> String {
    let mut text = name.to_owned();
    if let Some(timings) = timings {
        // Writing to a String cannot fail.
        write!(text, " ({timings})").ok();
    }
    for (output, value) in outputs.iter() {
        let text_form = format!("{value:#}");
        if text_form.trim().is_empty() {
            write!(text, "\n  {output}: none").ok();
        }
        for line in text_form.lines() {
            write!(text, "\n  {line}").ok();
        }
    }
    text
}
