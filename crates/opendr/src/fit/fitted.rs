//! What a training ends in.

use std::fmt;
use std::fs;
use std::path::PathBuf;

use opendr_datasets::Problem;
use opendr_engine::{Error, Result, ResultExt, Statistics};
use serde::Serialize;

/// The file of the report in the output folder.
const REPORT: &str = "report.json";

/// The numbers and curves of a training, and where its model lies. Printed, it is a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fitted {
    /// What was trained.
    pub learner: String,
    /// In which environment, where it learnt by acting.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub environment: Option<String>,
    /// On what data set; empty where it learnt by acting.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub dataset: String,
    /// How many samples were trained on.
    pub samples: usize,
    /// Whether it ran to its end; else it can be resumed from `output`.
    pub complete: bool,
    /// How long it took, seconds; of the last run where it was resumed.
    pub seconds: f64,
    /// The numbers and curves.
    #[serde(flatten)]
    pub statistics: Statistics,
    /// The folder of checkpoints and report.
    pub output: PathBuf,
    /// The trained model; `None` when it ended before there was one.
    pub model: Option<PathBuf>,
    /// The folder of event files and curves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub logging_path: Option<PathBuf>,
    /// Samples and annotations that were left out because they are broken.
    pub skipped: u64,
    /// What was left out.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub problems: Vec<Problem>,
}

impl Fitted {
    /// Writes `report.json` into the output folder.
    pub(super) fn write(&self) -> Result<()> {
        let json = serde_json::to_string_pretty(self)
            .map_err(|error| Error::internal("the report has no JSON form").with_source(error))?;
        let path = self.output.join(REPORT);
        fs::write(&path, json + "\n").context(|| format!("writing {}", path.display()))
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
            writeln!(f, "not complete: resume it from {}", self.output.display())?;
        }
        if self.skipped > 0 {
            writeln!(f, "{} left out as broken", self.skipped)?;
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
