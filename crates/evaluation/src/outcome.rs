//! Results of an evaluation.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use opendr_datasets::Problem;
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::params::ParamMap;
use opendr_engine::{JsonFormat, Result, ResultExt};
use opendr_metrics::{Report, Table};
use opendr_runlog::svg_from_figure;
use serde::{Deserialize, Serialize};

use crate::contact_sheet::{ScoredSample, contact_sheet};
use crate::{ClassReport, Interval};

/// Maximum rows of a printed table; the JSON has all.
const ROWS: usize = 40;
/// File name of the report in the output folder.
const REPORT: &str = "report.json";

/// Results of an evaluation. `Display` prints a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Name of the learner.
    pub learner: String,
    /// Name of the data set.
    pub dataset: String,
    /// Name of the metric.
    pub metric: String,
    /// All parameters of the metric.
    #[serde(default)]
    pub metric_params: ParamMap,
    /// Threshold of the learner, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub threshold: Option<f64>,
    /// How classes were matched.
    #[serde(default, skip_serializing_if = "ClassReport::is_empty")]
    pub classes: ClassReport,
    /// Number of samples of the data set.
    pub samples: usize,
    /// Number of samples with a prediction that the metric counted.
    pub counted: usize,
    /// Number of broken samples and annotations that were skipped.
    pub skipped: u64,
    /// Whether all samples were processed.
    pub complete: bool,
    /// Wall-clock time in seconds; that of the last run if it was resumed.
    pub seconds: f64,
    /// Numbers, tables and figures of the metric.
    #[serde(flatten)]
    pub report: Report,
    /// Confidence interval of the headline.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interval: Option<Interval>,
    /// Samples with the lowest scores, lowest first.
    #[serde(alias = "worst")]
    pub lowest_scores: Vec<ScoredSample>,
    /// Samples spaced evenly over the data set.
    #[serde(skip)]
    pub evenly_spaced: Vec<ScoredSample>,
    /// Skipped samples and annotations.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub problems: Vec<Problem>,
    /// Files that were written.
    #[serde(skip)]
    pub written: Vec<PathBuf>,
}

impl Outcome {
    /// Format of `report.json`. Version 2 renamed `worst` to `lowest_scores`, and `place` of a problem to `location`.
    pub const FORMAT: JsonFormat = JsonFormat::new("report of an evaluation", 2);

    /// Reads a report that [`Self::write_report`] of this version or of an earlier one wrote. The samples have no predictions.
    ///
    /// # Errors
    /// `Io`; `Format` for another file; `Unsupported` for a newer version.
    pub fn read(path: &Path) -> Result<Self> {
        let context = || format!("reading {}", path.display());
        let json = fs::read(path).context(context)?;
        Self::FORMAT.read(&json).context(context)
    }

    /// Writes `report.json`, an SVG file per figure, and two contact sheets into a folder. Predictions with a confidence below
    /// `least` are not drawn.
    pub(crate) fn write(&mut self, dataset: &dyn DatasetIterator, folder: &Path, least: f32) -> Result<()> {
        self.write_report(folder)?;
        for (name, samples) in
            [("lowest_scores.png", &self.lowest_scores), ("samples.png", &self.evenly_spaced)]
        {
            if let Some(sheet) = contact_sheet(samples, dataset, least)? {
                let path = folder.join(name);
                opendr_vision::save(&sheet, &path)?;
                self.written.push(path);
            }
        }
        Ok(())
    }

    /// Writes `report.json` and an SVG file per figure into a folder, which is created if missing.
    ///
    /// # Errors
    /// `Io` when a file cannot be written.
    pub fn write_report(&mut self, folder: &Path) -> Result<()> {
        fs::create_dir_all(folder).context(|| format!("creating {}", folder.display()))?;
        let mut files = vec![(REPORT.to_owned(), Self::FORMAT.to_pretty_json(self)?)];
        files.extend(self.report.figures.iter().map(|figure| {
            let (name, svg) = svg_from_figure(figure);
            (format!("{name}.svg"), svg)
        }));
        for (name, text) in files {
            let path = folder.join(name);
            fs::write(&path, text).context(|| format!("writing {}", path.display()))?;
            self.written.push(path);
        }
        Ok(())
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { learner, dataset, metric, samples, counted, seconds, .. } = self;
        write!(f, "{learner} on {dataset} by {metric}: {counted} of {samples} samples")?;
        if *seconds > 0.0 {
            write!(f, " in {seconds:.1} s")?;
        }
        writeln!(f)?;
        if !self.complete {
            writeln!(f, "not complete: the numbers cover the samples so far")?;
        }
        if self.skipped > 0 {
            writeln!(f, "{} skipped as broken", self.skipped)?;
        }
        self.write_comparison(f)?;
        let scalars = &self.report.statistics.scalars;
        let width = scalars.keys().map(String::len).max().unwrap_or(0);
        let main = scalars.get_key_value(&self.report.headline);
        let rest = scalars.iter().filter(|(key, _)| **key != self.report.headline);
        for (key, value) in main.into_iter().chain(rest) {
            write!(f, "  {key:width$}  {}", number(*value))?;
            match self.interval.filter(|_| *key == self.report.headline) {
                Some(Interval { low, high, level, resamples, units }) => writeln!(
                    f,
                    "  [{}, {}]: {:.0} % of {resamples} resamples of {units} {}",
                    number(low),
                    number(high),
                    level * 100.0,
                    if units == *samples { "samples" } else { "sequences" }
                )?,
                None => writeln!(f)?,
            }
        }
        self.report.tables.iter().try_for_each(|table| write_table(table, f))
    }
}

impl Outcome {
    /// Writes the settings of the comparison: threshold, parameters of the metric, classes.
    fn write_comparison(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let threshold = self.threshold.map(|threshold| format!("threshold {threshold}"));
        let params = self.metric_params.iter().map(|(name, value)| format!("{name} {value}"));
        let settings: Vec<_> = threshold.into_iter().chain(params).collect();
        if !settings.is_empty() {
            writeln!(f, "settings: {}", settings.join(", "))?;
        }
        if self.classes.is_empty() { Ok(()) } else { write!(f, "{}", self.classes) }
    }
}

fn write_table(table: &Table, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let labels = table.rows.iter().map(|(label, _)| label.chars().count());
    let first = labels.chain([table.name.chars().count()]).max().unwrap_or(0);
    let widths: Vec<_> = table.columns.iter().map(|column| column.chars().count().max(8)).collect();
    let whole: Vec<_> = (0..widths.len()).map(|column| is_of_counts(table, column)).collect();
    write!(f, "\n  {:first$}", table.name)?;
    for (column, width) in table.columns.iter().zip(&widths) {
        write!(f, "  {column:>width$}")?;
    }
    writeln!(f)?;
    for (label, numbers) in table.rows.iter().take(ROWS) {
        write!(f, "  {label:first$}")?;
        for ((value, width), whole) in numbers.iter().zip(&widths).zip(&whole) {
            let text = match value {
                None => "-".to_owned(),
                Some(value) if *whole => format!("{value}"),
                Some(value) => format!("{value:.4}"),
            };
            write!(f, "  {text:>width$}")?;
        }
        writeln!(f)?;
    }
    match table.rows.len().checked_sub(ROWS) {
        Some(more) if more > 0 => writeln!(f, "  ... {more} more in report.json"),
        _ => Ok(()),
    }
}

/// Returns whether a column has whole numbers, other than only zeros and ones.
fn is_of_counts(table: &Table, column: usize) -> bool {
    let numbers = || table.rows.iter().filter_map(|(_, numbers)| numbers.get(column).copied().flatten());
    numbers().all(|number| number.fract() == 0.0 && number.abs() < 1e15)
        && numbers().any(|number| number > 1.0)
}

/// Formats whole numbers as they are, others with four decimals.
fn number(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() >= 2.0 && value.abs() < 1e15 {
        format!("{value}")
    } else {
        format!("{value:.4}")
    }
}
