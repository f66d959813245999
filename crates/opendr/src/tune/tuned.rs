//! What a search ends in.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use serde::Serialize;
use serde_json::Value;

/// The best configuration, and what it comes to. Printed, it is a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tuned {
    /// What was tuned.
    pub learner: String,
    /// The best parameters; none before a trial is complete.
    pub params: Option<BTreeMap<String, Value>>,
    /// The mean over its seeds, by which they were chosen.
    pub value: Option<f64>,
    /// What they come to with seeds by which they were not chosen.
    pub fresh_values: Vec<f64>,
    /// The share of each parameter in what made the difference.
    pub importance: BTreeMap<String, f64>,
    /// How many trials the study has.
    pub trials: usize,
    /// Whether it ran to its end; else the same call goes on.
    pub complete: bool,
    /// How long it took, seconds; of the last call where it went on.
    pub seconds: f64,
    /// The folder of the study, its trials and figures.
    pub output: PathBuf,
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
