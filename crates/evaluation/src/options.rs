//! What a surface may say about an evaluation, in JSON.

use std::path::PathBuf;

use opendr_datasets::Problems;
use opendr_engine::dataset::{DatasetIterator, ExternalDataset, Subset};
use opendr_engine::learner::{AnyLearner, Entry};
use opendr_engine::params::ParamMap;
use opendr_engine::{Progress, Result};
use opendr_metrics::find;
use serde::Deserialize;

use crate::{Evaluation, Outcome, Subject, metric_of, open_for};

/// Everything that can be chosen; all of it may be left out.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EvalOptions {
    /// What to measure by; by default the task's own metric.
    pub metric: Option<String>,
    /// Parameters of the metric.
    pub metric_params: ParamMap,
    /// The part of the data set.
    pub split: Option<String>,
    /// Only the first so many samples.
    pub limit: Option<usize>,
    /// The folder for answers, report and pictures.
    pub folder: Option<PathBuf>,
    /// Whether what is broken is left out and listed.
    pub skip_broken: bool,
}

impl EvalOptions {
    /// Measures a loaded learner on a data set on disk.
    ///
    /// # Errors
    /// As [`open_for`] and [`Evaluation::run`].
    pub fn run(
        &self,
        learner: &mut Box<dyn AnyLearner>,
        entry: &Entry,
        external: &ExternalDataset,
        progress: &dyn Progress,
    ) -> Result<Outcome> {
        let problems = if self.skip_broken { Problems::skipping() } else { Problems::strict() };
        let metric = find(match &self.metric {
            Some(name) => name,
            None => metric_of(entry.spec.task)?,
        })?;
        let dataset = open_for(metric, external, self.split.clone(), &problems)?;
        let dataset: Subset<Box<dyn DatasetIterator>> =
            Subset::first(dataset, self.limit.unwrap_or(usize::MAX));
        let subject = Subject { learner: entry.spec.name.to_owned(), model: None, params: learner.params() };
        let evaluation = Evaluation {
            dataset: external.path().display().to_string(),
            metric_params: self.metric_params.clone(),
            folder: self.folder.as_deref(),
            progress,
            ..Evaluation::new(subject, metric, &problems)
        };
        evaluation.run(std::slice::from_mut(learner), entry, &dataset)
    }
}
