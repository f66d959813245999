//! Evaluation of a learner on a data set.

use std::fs;
use std::ops::Range;
use std::path::Path;
use std::time::Instant;

use opendr_datasets::{Problem, Problems};
use opendr_engine::dataset::{DatasetIterator, Subset};
use opendr_engine::learner::{AnyLearner, Entry, Port};
use opendr_engine::params::{ParamMap, ParamValue};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Progress, Result, ResultExt, Silent, Unit, Value};
use opendr_metrics::MetricEntry;

use crate::bootstrap::Groups;
use crate::classes::{AnnotatedClasses, MapLabels, annotated_classes};
use crate::contact_sheet::{ContactSheetSamples, ScoredSample};
use crate::journal::{Heading, Journal, Line, PREDICTIONS_FORMAT, SampleResult, json_line};
use crate::predictor::PredictionJob;
use crate::{ClassMap, ClassMatching, FilePredictions, Outcome, Predictor, SampleObserver, Subject};

/// Number of samples with the lowest scores that are listed, and of those spaced evenly over the data set.
const LISTED: usize = 24;
/// Name of the score threshold of learners, and its value for metrics that rank predictions.
const THRESHOLD: &str = "threshold";
const LOW_THRESHOLD: f64 = 0.01;
/// Bootstrap resamples for the interval of the headline.
pub(crate) const RESAMPLES: usize = 200;
/// Advice for classes that do not match.
const REMEDY: &str = "Map them with classes (--classes LEARNER=DATASET,...), or compare their numbers with by_number (--by-number)";
/// File of the predictions.
const JOURNAL: &str = "predictions.jsonl";

/// Settings of an evaluation.
pub struct Evaluation<'a> {
    /// The evaluated learner.
    pub subject: Subject,
    /// Name of the data set in the outcome.
    pub dataset: String,
    /// Metric.
    pub metric: &'static MetricEntry,
    /// Parameters of the metric.
    pub metric_params: ParamMap,
    /// How classes are matched.
    pub classes: ClassMatching,
    /// Number of bootstrap resamples for the interval of the headline; 0 for no interval.
    pub resamples: usize,
    /// Folder to which every prediction is written at once, and at the end the report and its images. An interrupted
    /// evaluation resumes from it.
    pub folder: Option<&'a Path>,
    /// Whether broken samples are skipped and listed, or end the evaluation.
    pub problems: &'a Problems,
    /// Receives the progress, and may stop the evaluation.
    pub progress: &'a dyn Progress,
    /// Receives each sample with the outputs of the learner.
    pub observer: Option<&'a SampleObserver<'a>>,
}

impl<'a> Evaluation<'a> {
    /// Creates an evaluation without progress output and without a folder.
    pub fn new(subject: Subject, metric: &'static MetricEntry, problems: &'a Problems) -> Self {
        Self {
            subject,
            dataset: String::new(),
            metric,
            metric_params: ParamMap::new(),
            classes: ClassMatching::default(),
            resamples: RESAMPLES,
            folder: None,
            problems,
            progress: &Silent,
            observer: None,
        }
    }

    /// Evaluates loaded `learners` of one kind on the data set. As many samples run in parallel as there are learners;
    /// sequences run on the first only.
    ///
    /// If the user stops it, the outcome covers the samples so far and is marked as incomplete.
    ///
    /// # Errors
    /// `InvalidInput` when data set, learner and metric are incompatible, and for a broken sample unless problems are
    /// skipped; `Io` when the journal cannot be written.
    pub fn run(
        &self,
        learners: &mut [Box<dyn AnyLearner>],
        entry: &Entry,
        dataset: &dyn DatasetIterator,
    ) -> Result<Outcome> {
        let classes = learners.first().map(|learner| learner.classes()).unwrap_or_default();
        let lowered = self.lower_threshold(learners)?;
        let threshold = learners.first().and_then(|learner| learner.params().remove(THRESHOLD)?.as_float());
        let outcome = self.run_predictors(learners, entry.ports, classes, dataset, |outcome| {
            outcome.threshold = threshold;
            lowered.as_ref().and_then(ParamValue::as_float).unwrap_or(0.0) as f32
        });
        if let Some(threshold) = &lowered {
            learners.iter_mut().try_for_each(|learner| learner.set(THRESHOLD, threshold.clone()))?;
        }
        outcome
    }

    /// Predicts a part of the samples with the parameters of the learners as they are, without a metric: for evaluations whose parts run
    /// on several machines. Returns a line for each sample. [`Evaluation::heading`] and the lines of all parts in their order are the file
    /// of predictions from which the whole evaluation resumes.
    ///
    /// # Errors
    /// `Internal` for a prediction that cannot be written as JSON.
    pub fn predict_part(
        &self,
        learners: &mut [Box<dyn AnyLearner>],
        ports: &[Port],
        dataset: &dyn DatasetIterator,
        part: Range<usize>,
    ) -> Result<String> {
        let samples = Subset::first(dataset, part.end);
        let (wanted, observer) = (self.metric.prediction, self.observer);
        let job = PredictionJob { ports, dataset: &samples, first: part.start, wanted, observer };
        let mut lines = String::new();
        job.predict(learners, self.progress, |line| {
            lines.push_str(&json_line(&line)?);
            Ok(())
        })?;
        Ok(lines)
    }

    /// Returns the first line of the file of predictions.
    ///
    /// # Errors
    /// `Internal` where it cannot be written as JSON.
    pub fn heading(&self, dataset: &dyn DatasetIterator) -> Result<String> {
        Ok(PREDICTIONS_FORMAT.to_json(&Heading::new(self.subject.clone(), self.dataset.clone(), dataset))?
            + "\n")
    }

    /// Evaluates predictors with the inputs `ports`, as [`Evaluation::run`] evaluates learners. `classes` are the classes of their
    /// predictions, where these do not name them. Thresholds are not changed.
    ///
    /// # Errors
    /// As [`Evaluation::run`].
    pub fn run_pipelines<P: Predictor>(
        &self,
        predictors: &mut [P],
        ports: &[Port],
        classes: Classes,
        dataset: &dyn DatasetIterator,
    ) -> Result<Outcome> {
        self.run_predictors(predictors, ports, classes, dataset, |_| 0.0)
    }

    /// `describe` completes the outcome and returns the confidence below which predictions are not drawn.
    fn run_predictors<P: Predictor>(
        &self,
        predictors: &mut [P],
        ports: &[Port],
        classes: Classes,
        dataset: &dyn DatasetIterator,
        describe: impl FnOnce(&mut Outcome) -> f32,
    ) -> Result<Outcome> {
        let begun = Instant::now();
        let mut tally = self.begin(dataset, classes)?;
        let done =
            self.resume(&mut tally).and_then(|journal| self.predict(predictors, ports, &mut tally, journal));
        self.progress.end();
        done?;
        self.finish(tally, begun, describe)
    }

    /// Returns the threshold for metrics that rank predictions of all scores, instead of the learner's if that is the default and
    /// larger.
    pub fn lowered_threshold(&self, learner: &dyn AnyLearner) -> Option<ParamValue> {
        let was = learner.params().remove(THRESHOLD).filter(|_| self.metric.is_ranking)?;
        let is_default = learner.default_of(THRESHOLD).as_ref() == Some(&was);
        (is_default && was.as_float()? > LOW_THRESHOLD).then_some(ParamValue::Float(LOW_THRESHOLD))
    }

    /// Sets the [lowered threshold](Self::lowered_threshold). Returns the original value.
    fn lower_threshold(&self, learners: &mut [Box<dyn AnyLearner>]) -> Result<Option<ParamValue>> {
        let Some(first) = learners.first() else { return Ok(None) };
        let Some(low) = self.lowered_threshold(first.as_ref()) else { return Ok(None) };
        let was = first.params().remove(THRESHOLD);
        learners.iter_mut().try_for_each(|learner| learner.set(THRESHOLD, low.clone()))?;
        if let Some(was) = &was {
            self.progress.note(&format!(
                "threshold {LOW_THRESHOLD} instead of {was}: {} ranks predictions of all scores",
                self.metric.name
            ));
        }
        Ok(was)
    }

    /// Evaluates predictions from files.
    ///
    /// # Errors
    /// As [`Evaluation::run`].
    pub fn score(&self, predictions: &FilePredictions, dataset: &dyn DatasetIterator) -> Result<Outcome> {
        let begun = Instant::now();
        let mut tally = self.begin(dataset, predictions.classes())?;
        let done = (0..dataset.len()).take_while(|_| !self.progress.stopped()).try_for_each(|at| {
            let prediction = predictions.get(at, self.metric.prediction);
            self.progress.advance(1);
            tally.count(Line {
                at,
                name: dataset.name(at),
                result: SampleResult::of(prediction, dataset, at),
            })
        });
        self.progress.end();
        done?;
        if let Some(folder) = self.folder {
            fs::create_dir_all(folder).context(|| format!("creating {}", folder.display()))?;
        }
        self.finish(tally, begun, |_| 0.0)
    }

    fn begin<'d>(&self, dataset: &'d dyn DatasetIterator, learner: Classes) -> Result<Tally<'d>>
    where
        'a: 'd,
    {
        let AnnotatedClasses { classes, occurring } = annotated_classes(dataset, self.metric.ground_truth);
        let labels = if self.metric.segments { MapLabels::Segments } else { MapLabels::Classes };
        let map = ClassMap::new(learner, classes.clone(), &self.classes)?.with_labels(labels);
        map.check(occurring.as_deref(), REMEDY)?;
        let (units, in_sequences) = units_of(dataset);
        let mut groups = Groups::new(self.metric.make(&self.metric_params)?, units);
        groups.name_classes(&classes);
        self.progress.begin("evaluating", Some(dataset.len() as u64), Unit::Items);
        Ok(Tally {
            groups,
            unit: 0,
            in_sequences,
            occurring,
            classes: map,
            listed: ContactSheetSamples::new(LISTED, dataset.len()),
            next: 0,
            counted: 0,
            dataset,
            problems: self.problems,
        })
    }

    fn finish(
        &self,
        tally: Tally<'_>,
        begun: Instant,
        describe: impl FnOnce(&mut Outcome) -> f32,
    ) -> Result<Outcome> {
        tally.classes.check(tally.occurring.as_deref(), REMEDY)?;
        let complete = tally.next == tally.dataset.len();
        let report = tally.groups.report()?;
        let interval = tally.groups.interval(&report, self.resamples, self.progress)?;
        let (lowest_scores, evenly_spaced) = tally.listed.into_samples();
        let mut outcome = Outcome {
            learner: self.subject.learner.clone(),
            dataset: self.dataset.clone(),
            metric: self.metric.name.to_owned(),
            metric_params: self.metric_settings(),
            threshold: None,
            classes: tally.classes.report(),
            samples: tally.dataset.len(),
            counted: tally.counted,
            skipped: self.problems.count(),
            complete,
            seconds: begun.elapsed().as_secs_f64(),
            report,
            interval,
            lowest_scores,
            evenly_spaced,
            problems: self.problems.list(),
            written: Vec::new(),
        };
        let least = describe(&mut outcome);
        if let Some(folder) = self.folder {
            outcome.write(tally.dataset, folder, least)?;
        }
        Ok(outcome)
    }

    /// Returns all parameters of the metric with their values.
    fn metric_settings(&self) -> ParamMap {
        let defaults = self.metric.params.iter().map(|field| (field.name.to_owned(), field.default.value()));
        defaults.chain(self.metric_params.clone()).collect()
    }

    /// Counts the predictions in the journal.
    fn resume(&self, tally: &mut Tally<'_>) -> Result<Option<Journal>> {
        let Some(folder) = self.folder else { return Ok(None) };
        fs::create_dir_all(folder).context(|| format!("creating {}", folder.display()))?;
        let dataset = tally.dataset;
        let heading = Heading::new(self.subject.clone(), self.dataset.clone(), dataset);
        let journal = Journal::resume(&folder.join(JOURNAL), &heading, dataset, |line| {
            self.progress.advance(1);
            tally.count(line)
        })?;
        if tally.next > 0 && tally.next < dataset.len() {
            self.progress.note(&format!("resuming after {} of {} samples", tally.next, dataset.len()));
        }
        Ok(Some(journal))
    }

    /// Predicts the remaining samples.
    fn predict<P: Predictor>(
        &self,
        predictors: &mut [P],
        ports: &[Port],
        tally: &mut Tally<'_>,
        mut journal: Option<Journal>,
    ) -> Result<()> {
        let (dataset, first) = (tally.dataset, tally.next);
        let wanted = self.metric.prediction;
        let job = PredictionJob { ports, dataset, first, wanted, observer: self.observer };
        job.predict(predictors, self.progress, |line| {
            if let Some(journal) = &mut journal {
                journal.write(&line)?;
            }
            tally.count(line)
        })
    }
}

/// State of an evaluation.
struct Tally<'a> {
    groups: Groups,
    /// Index of the current sample or sequence.
    unit: usize,
    in_sequences: bool,
    /// Indices of the data set's classes that are annotated.
    occurring: Option<Vec<usize>>,
    classes: ClassMap,
    listed: ContactSheetSamples,
    /// Index of the next sample.
    next: usize,
    counted: usize,
    dataset: &'a dyn DatasetIterator,
    problems: &'a Problems,
}

impl Tally<'_> {
    fn count(&mut self, line: Line) -> Result<()> {
        let (at, dataset) = (line.at, self.dataset);
        self.next = at + 1;
        match self.score(line) {
            Ok((score, prediction)) => {
                self.counted += 1;
                self.listed.add(&ScoredSample {
                    index: at,
                    name: dataset.name(at),
                    score,
                    prediction: Some(prediction),
                });
            }
            Err(problem) => self.problems.report(problem)?,
        }
        let ends = at + 1 == dataset.len() || dataset.sequence(at) != dataset.sequence(at + 1);
        if dataset.sequence(at).is_some() && ends {
            self.groups.of(self.unit).end_sequence();
        }
        self.unit += usize::from(!self.in_sequences || ends);
        Ok(())
    }

    fn score(&mut self, line: Line) -> std::result::Result<(f64, Value), Problem> {
        let (at, dataset) = (line.at, self.dataset);
        let mut prediction = match line.result {
            SampleResult::Prediction(prediction) => *prediction,
            SampleResult::Error(problem) => return Err(problem),
        };
        let mapped = self.classes.apply(&mut prediction);
        let counted = mapped.and_then(|()| dataset.target(at)).and_then(|ground_truth| {
            let ground_truth = ground_truth
                .ok_or_else(|| Error::invalid_input("the sample has no annotation to compare with"))?;
            self.groups.of(self.unit).update(at, (&prediction).into(), (&ground_truth).into())
        });
        match counted {
            Ok(score) => Ok((score, prediction)),
            Err(error) => Err(Problem::of(&error, dataset, at)),
        }
    }
}

/// Returns the number of independent units, and whether they are sequences instead of samples.
fn units_of(dataset: &dyn DatasetIterator) -> (usize, bool) {
    if dataset.is_empty() || dataset.sequence(0).is_none() {
        return (dataset.len(), false);
    }
    let begins = |at: &usize| *at == 0 || dataset.sequence(*at) != dataset.sequence(at - 1);
    ((0..dataset.len()).filter(begins).count(), true)
}
