//! What a surface may say about an evaluation, in JSON.

use std::collections::BTreeMap;
use std::path::PathBuf;

use opendr_datasets::Problems;
use opendr_engine::dataset::{DatasetIterator, DatasetRef, Subset};
use opendr_engine::learner::{AnyLearner, Entry, Port};
use opendr_engine::params::ParamMap;
use opendr_engine::target::Classes;
use opendr_engine::{Progress, Result};
use opendr_metrics::{MetricEntry, find};
use serde::Deserialize;

use crate::evaluation::RESAMPLES;
use crate::{ClassMatching, Evaluation, Outcome, Predictor, Subject, metric_of, open_for};

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
    #[serde(alias = "folder")]
    pub out: Option<PathBuf>,
    /// Whether what is broken is left out and listed.
    pub skip_broken: bool,
    /// Classes of the data set by classes of the learner, where their names do not match.
    pub classes: BTreeMap<String, String>,
    /// Whether class numbers are compared, whatever the names are.
    pub by_number: bool,
    /// Number of bootstrap resamples for the interval of the headline, by default 200; 0 leaves it out.
    pub resamples: Option<usize>,
    /// What the outcome calls the data set; by default its path.
    pub name: Option<String>,
}

/// A data set opened as the options of an evaluation want it.
pub struct EvalJob<'a> {
    /// Its samples.
    pub dataset: Subset<Box<dyn DatasetIterator + 'a>>,
    /// What is broken in it.
    pub problems: Problems,
    metric: &'static MetricEntry,
    name: String,
    options: &'a EvalOptions,
}

impl EvalOptions {
    /// What a learner is measured by.
    ///
    /// # Errors
    /// `NotFound` for a metric that there is not; as [`metric_of`] where none is named.
    pub fn metric_for(&self, entry: &Entry) -> Result<&'static MetricEntry> {
        find(match &self.metric {
            Some(name) => name,
            None => metric_of(entry.spec.task)?,
        })
    }

    /// How classes are matched.
    pub fn class_matching(&self) -> ClassMatching {
        ClassMatching { pairs: self.classes.clone(), by_number: self.by_number }
    }

    /// Opens the data set that a learner is measured on.
    ///
    /// # Errors
    /// As [`EvalOptions::metric_for`] and [`open_for`].
    pub fn open<'a>(&'a self, entry: &Entry, dataset: DatasetRef<'a>) -> Result<EvalJob<'a>> {
        self.open_by(self.metric_for(entry)?, dataset)
    }

    /// Opens the data set as `metric` compares it.
    ///
    /// # Errors
    /// As [`open_for`].
    pub fn open_by<'a>(
        &'a self,
        metric: &'static MetricEntry,
        dataset: DatasetRef<'a>,
    ) -> Result<EvalJob<'a>> {
        let problems = if self.skip_broken { Problems::skipping() } else { Problems::strict() };
        let (name, dataset): (_, Box<dyn DatasetIterator + 'a>) = match dataset {
            DatasetRef::External(external) => {
                let name = external.path().display().to_string();
                (name, open_for(metric, external, self.split.clone(), &problems)?)
            }
            DatasetRef::Iterator(samples) => (String::new(), Box::new(samples)),
        };
        let name = self.name.clone().unwrap_or(name);
        let dataset = Subset::first(dataset, self.limit.unwrap_or(usize::MAX));
        Ok(EvalJob { dataset, problems, metric, name, options: self })
    }

    /// Measures a loaded learner on a data set.
    ///
    /// # Errors
    /// As [`EvalOptions::open`] and [`Evaluation::run`].
    pub fn run(
        &self,
        learner: &mut Box<dyn AnyLearner>,
        entry: &Entry,
        dataset: DatasetRef<'_>,
        progress: &dyn Progress,
    ) -> Result<Outcome> {
        let subject = Subject { learner: entry.spec.name.to_owned(), model: None, params: learner.params() };
        self.open(entry, dataset)?.run(std::slice::from_mut(learner), entry, subject, progress)
    }
}

impl EvalJob<'_> {
    /// Measures loaded `learners` of one kind, as many samples at once as there are learners.
    ///
    /// # Errors
    /// As [`Evaluation::run`].
    pub fn run(
        &self,
        learners: &mut [Box<dyn AnyLearner>],
        entry: &Entry,
        subject: Subject,
        progress: &dyn Progress,
    ) -> Result<Outcome> {
        self.evaluation(subject, progress).run(learners, entry, &self.dataset)
    }

    /// Measures learners behind each other that take `ports`, as many samples at once as there are of them; `classes` are what the
    /// class numbers of their predictions mean, as far as these do not say it.
    ///
    /// # Errors
    /// As [`Evaluation::run`].
    pub fn run_pipelines<P: Predictor>(
        &self,
        pipelines: &mut [P],
        ports: &[Port],
        classes: Classes,
        subject: Subject,
        progress: &dyn Progress,
    ) -> Result<Outcome> {
        self.evaluation(subject, progress).run_pipelines(pipelines, ports, classes, &self.dataset)
    }

    fn evaluation<'e>(&'e self, subject: Subject, progress: &'e dyn Progress) -> Evaluation<'e> {
        Evaluation {
            dataset: self.name.clone(),
            metric_params: self.options.metric_params.clone(),
            classes: self.options.class_matching(),
            resamples: self.options.resamples.unwrap_or(RESAMPLES),
            folder: self.options.out.as_deref(),
            progress,
            ..Evaluation::new(subject, self.metric, &self.problems)
        }
    }
}
