//! Result of a search.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use opendr_engine::JsonFormat;
use serde::Serialize;
use serde_json::Value;

/// Best configuration and its values. `Display` prints a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tuned {
    /// Name of the learner.
    pub learner: String,
    /// Best parameters; `None` before a trial is complete.
    pub params: Option<BTreeMap<String, Value>>,
    /// Mean over the seeds of the trial, by which the parameters were chosen.
    pub value: Option<f64>,
    /// Values of the best parameters with new seeds, which had no part in the choice.
    pub fresh_values: Vec<f64>,
    /// Importance of each parameter by PED-ANOVA; the sum is 1.
    pub importance: BTreeMap<String, f64>,
    /// Number of trials of the study.
    pub trials: usize,
    /// Whether the search ran to its end; else the same call resumes it.
    pub complete: bool,
    /// Duration in seconds; of a resumed search, that of the last call.
    pub seconds: f64,
    /// Folder of the study, its trials and figures.
    pub output: PathBuf,
}

impl Tuned {
    /// Format of the result as JSON.
    pub const FORMAT: JsonFormat = JsonFormat::new("result of a search", 1);
}

impl fmt::Display for Tuned {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} tuned in {} trials, {:.1} s", self.learner, self.trials, self.seconds)?;
        let Some(params) = &self.params else { return writeln!(f, "no trial is complete") };
        let width = params.keys().map(String::len).max().unwrap_or(0);
        for (name, value) in params {
            let share = self.importance.get(name).map(|share| format!("  importance {share:.2}"));
            writeln!(f, "  {name:width$}  {value}{}", share.unwrap_or_default())?;
        }
        if let Some(value) = self.value {
            writeln!(f, "value {value:.4}, by which it was chosen")?;
        }
        if !self.fresh_values.is_empty() {
            let mean = self.fresh_values.iter().sum::<f64>() / self.fresh_values.len() as f64;
            writeln!(f, "value {mean:.4} with {} fresh seeds", self.fresh_values.len())?;
        }
        writeln!(f, "study: {}", self.output.display())
    }
}
