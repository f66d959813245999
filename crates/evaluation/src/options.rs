//! Options of an evaluation, as JSON.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;

use opendr_datasets::Problems;
use opendr_engine::dataset::{DatasetIterator, DatasetRef, Subset};
use opendr_engine::learner::{AnyLearner, Entry, Port};
use opendr_engine::params::ParamMap;
use opendr_engine::target::Classes;
use opendr_engine::{Progress, Result, Silent};
use opendr_metrics::{MetricEntry, find};
use serde::Deserialize;

use crate::evaluation::RESAMPLES;
use crate::{
    ClassMatching, Evaluation, Outcome, Predictor, SampleObserver, Subject, metric_of, open_for_metric,
};

/// All options; each may be omitted.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EvalOptions {
    /// Name of the metric; by default that of the task.
    pub metric: Option<String>,
    /// Parameters of the metric.
    pub metric_params: ParamMap,
    /// Split of the data set, such as `val`.
    pub split: Option<String>,
    /// Maximum number of samples, from the first.
    pub limit: Option<usize>,
    /// Folder for predictions, report and images.
    #[serde(alias = "folder")]
    pub out: Option<PathBuf>,
    /// Whether broken samples are skipped and listed.
    pub skip_broken: bool,
    /// Maps classes of the learner to classes of the data set, where their names do not match.
    pub classes: BTreeMap<String, String>,
    /// Whether classes are compared by number, regardless of their names.
    pub by_number: bool,
    /// Number of bootstrap resamples for the interval of the headline, 200 by default; 0 for no interval.
    pub resamples: Option<usize>,
    /// Name of the data set in the outcome; by default its path.
    pub name: Option<String>,
}

/// A data set opened for an evaluation.
pub struct EvalJob<'a> {
    /// The samples.
    pub dataset: Subset<Box<dyn DatasetIterator + 'a>>,
    /// The problems found in them.
    pub problems: Problems,
    /// Receives each sample with the outputs of the learner.
    pub observer: Option<&'a SampleObserver<'a>>,
    metric: &'static MetricEntry,
    name: String,
    options: &'a EvalOptions,
}

/// What the machines of an evaluation in parts do.
#[derive(Debug, Clone, PartialEq)]
pub struct PartsPlan {
    /// First line of the file of predictions.
    pub heading: String,
    /// Parameters of the learners that predict, where they are others than those of the evaluated one.
    pub params: ParamMap,
    /// First sample of each part, and the one after its last.
    pub parts: Vec<[usize; 2]>,
}

impl EvalOptions {
    /// Returns the metric of an evaluation.
    ///
    /// # Errors
    /// `NotFound` for an unknown metric; as [`metric_of`] when none is named.
    pub fn metric_for(&self, entry: &Entry) -> Result<&'static MetricEntry> {
        find(match &self.metric {
            Some(name) => name,
            None => metric_of(entry.spec.task)?,
        })
    }

    /// Returns how classes are matched.
    pub fn class_matching(&self) -> ClassMatching {
        ClassMatching { pairs: self.classes.clone(), by_number: self.by_number }
    }

    /// Opens the data set for the metric of a learner.
    ///
    /// # Errors
    /// As [`EvalOptions::metric_for`] and [`open_for_metric`].
    pub fn open<'a>(&'a self, entry: &Entry, dataset: DatasetRef<'a>) -> Result<EvalJob<'a>> {
        self.open_by(self.metric_for(entry)?, dataset)
    }

    /// Opens the data set for a metric.
    ///
    /// # Errors
    /// As [`open_for_metric`].
    pub fn open_by<'a>(
        &'a self,
        metric: &'static MetricEntry,
        dataset: DatasetRef<'a>,
    ) -> Result<EvalJob<'a>> {
        let problems = Problems::new(self.skip_broken);
        let (name, dataset): (_, Box<dyn DatasetIterator + 'a>) = match dataset {
            DatasetRef::External(external) => {
                let name = external.path().display().to_string();
                (name, open_for_metric(metric, external, self.split.clone(), &problems)?)
            }
            DatasetRef::Iterator(samples) => (String::new(), Box::new(samples)),
        };
        let name = self.name.clone().unwrap_or(name);
        let dataset = Subset::first(dataset, self.limit.unwrap_or(usize::MAX));
        Ok(EvalJob { dataset, problems, observer: None, metric, name, options: self })
    }

    /// Evaluates a loaded learner on a data set.
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
        let subject = Subject::of(entry, learner.as_ref());
        self.open(entry, dataset)?.run(std::slice::from_mut(learner), entry, subject, progress)
    }
}

impl EvalJob<'_> {
    /// Evaluates loaded `learners` of one kind, with as many samples in parallel.
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
        let mut evaluation = self.evaluation(subject, progress);
        if self.is_of_task(entry) {
            let needed = learners.first().map(|learner| learner.metric_params()).unwrap_or_default();
            for (name, value) in needed {
                evaluation.metric_params.entry(name).or_insert(value);
            }
        }
        evaluation.run(learners, entry, &self.dataset)
    }

    /// Returns at most `count` parts of the samples from `first` on, of about the same size and without a sequence in two of them: the first
    /// sample of each, and the one after its last.
    fn parts(&self, first: usize, count: usize) -> Vec<[usize; 2]> {
        let (begin, samples) = (first.min(self.dataset.len()), self.dataset.len());
        let mut parts = Vec::new();
        let mut start = begin;
        for part in 1..=count.max(1) {
            let end = begin + (samples - begin) * part / count.max(1);
            let end = if end == samples { end } else { self.end_of_sequence(end) };
            if end > start {
                parts.push([start, end]);
                start = end;
            }
        }
        parts
    }

    /// Returns the sample after the sequence of the sample before `end`.
    fn end_of_sequence(&self, end: usize) -> usize {
        let same = |at: usize| {
            let sequence = self.dataset.sequence(at);
            at > 0 && sequence.is_some() && sequence == self.dataset.sequence(at - 1)
        };
        (end..self.dataset.len()).find(|at| !same(*at)).unwrap_or(self.dataset.len())
    }

    /// Returns the plan of an evaluation whose parts run elsewhere.
    ///
    /// # Errors
    /// As [`Evaluation::heading`].
    pub fn plan(
        &self,
        learner: &dyn AnyLearner,
        entry: &Entry,
        first: usize,
        count: usize,
    ) -> Result<PartsPlan> {
        let evaluation = self.evaluation(Subject::of(entry, learner), &Silent);
        Ok(PartsPlan {
            heading: evaluation.heading(&self.dataset)?,
            params: evaluation
                .lowered_threshold(learner)
                .map(|low| ("threshold".to_owned(), low))
                .into_iter()
                .collect(),
            parts: self.parts(first, count),
        })
    }

    /// Predicts a part of the samples; see [`Evaluation::predict_part`].
    ///
    /// # Errors
    /// As [`Evaluation::predict_part`].
    pub fn predict_part(
        &self,
        learners: &mut [Box<dyn AnyLearner>],
        entry: &Entry,
        part: Range<usize>,
        progress: &dyn Progress,
    ) -> Result<String> {
        let evaluation = self.evaluation(Subject::default(), progress);
        evaluation.predict_part(learners, entry.ports, &self.dataset, part)
    }

    /// Returns whether the metric is that of the task of a learner.
    fn is_of_task(&self, entry: &Entry) -> bool {
        metric_of(entry.spec.task).is_ok_and(|name| name == self.metric.name)
    }

    /// Evaluates pipelines with the inputs `ports`, with as many samples in parallel; `classes` are the classes of their predictions,
    /// where these do not name them.
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
            observer: self.observer,
            ..Evaluation::new(subject, self.metric, &self.problems)
        }
    }
}
