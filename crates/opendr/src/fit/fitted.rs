//! Result of a training.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use opendr_datasets::Problem;
use opendr_engine::{JsonFormat, Progress, Result, ResultExt, Statistics};
use serde::{Deserialize, Serialize};

/// File name of the report in the output folder.
const REPORT: &str = "report.json";

/// Metrics and curves of a training, and the path of its model. `Display` prints a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fitted {
    /// Name of the learner.
    pub learner: String,
    /// Environment of the training, for policies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub environment: Option<String>,
    /// Data set of the training; empty for policies.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub dataset: String,
    /// Number of training samples.
    pub samples: usize,
    /// Whether the training ran to its end; else it can be resumed from `output`.
    pub complete: bool,
    /// Duration in seconds; of a resumed training, that of the last run.
    pub seconds: f64,
    /// Metrics and curves.
    #[serde(flatten)]
    pub statistics: Statistics,
    /// Folder of checkpoints and report.
    pub output: PathBuf,
    /// Trained model; `None` when the training ended before the first one.
    pub model: Option<PathBuf>,
    /// Folder of event files and curves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub logging_path: Option<PathBuf>,
    /// Number of skipped broken samples and annotations.
    pub skipped: u64,
    /// Descriptions of skipped samples and annotations.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub problems: Vec<Problem>,
}

impl Fitted {
    /// Format of `report.json`. Version 2 renamed `place` of a problem to `location`.
    pub const FORMAT: JsonFormat = JsonFormat::new("report of a training", 2);

    /// Reads the report of a training by this version or an earlier one.
    ///
    /// # Errors
    /// `Io`; `Format` for another file; `Unsupported` for a newer version.
    pub fn read(path: &Path) -> Result<Self> {
        let context = || format!("reading {}", path.display());
        let json = fs::read(path).context(context)?;
        Self::FORMAT.read(&json).context(context)
    }

    /// Writes the report, and prints a note if the training was stopped.
    pub(super) fn finish(self, progress: &dyn Progress) -> Result<Self> {
        self.write()?;
        if !self.complete {
            progress.note(&format!(
                "stopped: the state is in {}, from which the training resumes",
                self.output.display()
            ));
        }
        Ok(self)
    }

    /// Writes `report.json` into the output folder.
    fn write(&self) -> Result<()> {
        let path = self.output.join(REPORT);
        fs::write(&path, Self::FORMAT.to_pretty_json(self)?).context(|| format!("writing {}", path.display()))
    }
}

impl fmt::Display for Fitted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { learner, dataset, samples, seconds, statistics, .. } = self;
        match &self.environment {
            Some(environment) => writeln!(f, "{learner} trained in {environment} in {seconds:.1} s")?,
            None => writeln!(f, "{learner} trained on {samples} samples of {dataset} in {seconds:.1} s")?,
        }
        if !self.complete {
            writeln!(f, "not complete; resume it from {}", self.output.display())?;
        }
        if self.skipped > 0 {
            writeln!(f, "{} broken samples skipped", self.skipped)?;
        }
        let names = statistics.scalars.keys().chain(statistics.curves.keys());
        let width = names.map(String::len).max().unwrap_or(0);
        for (name, value) in &statistics.scalars {
            writeln!(f, "  {name:width$}  {value:.6}")?;
        }
        for (name, curve) in &statistics.curves {
            if let (Some(first), Some(last)) = (curve.first(), curve.last()) {
                writeln!(f, "  {name:width$}  {first:.6} to {last:.6} in {} values", curve.len())?;
            }
        }
        if let Some(model) = &self.model {
            writeln!(f, "model: {}", model.display())?;
        }
        match &self.logging_path {
            Some(path) => writeln!(f, "curves: {}", path.display()),
            None => Ok(()),
        }
    }
}
