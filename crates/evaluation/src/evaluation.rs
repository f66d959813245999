//! A learner over a data set.

use std::fs;
use std::path::Path;
use std::time::Instant;

use opendr_datasets::{Problem, Problems};
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::learner::{AnyLearner, Entry, Port};
use opendr_engine::params::{ParamMap, ParamValue};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Progress, Result, ResultExt, Silent, Unit, Value};
use opendr_metrics::MetricEntry;
use serde::{Deserialize, Serialize};

use crate::bootstrap::Groups;
use crate::classes::{AnnotatedClasses, MapLabels, annotated_classes};
use crate::journal::{Answer, Heading, Journal, Line};
use crate::predictor::predict_samples;
use crate::shown::{AnsweredSample, Shown};
use crate::{Answers, ClassMap, ClassMatching, Outcome, Predictor};

/// The worst samples that are listed, and as many evenly over the data set.
const SHOWN: usize = 24;
/// The parameter below which learners drop answers, and what it is made where answers are ranked.
const THRESHOLD: &str = "threshold";
const LOW_THRESHOLD: f64 = 0.01;
/// Resamples for the interval of the headline.
pub(crate) const RESAMPLES: usize = 200;
/// What to do about classes that do not match.
const REMEDY: &str = "Map them with classes (--classes LEARNER=DATASET,...), or compare their numbers with by_number (--by-number)";
/// The file of the answers.
const JOURNAL: &str = "predictions.jsonl";

/// What is evaluated: journals and outcomes name it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Subject {
    /// The learner, with its variant.
    pub learner: String,
    /// The model container, where it is the user's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub model: Option<String>,
    /// The learner's parameters.
    pub params: ParamMap,
}

/// How an evaluation is done.
pub struct Evaluation<'a> {
    /// What is evaluated.
    pub subject: Subject,
    /// What the data set is called in the outcome.
    pub dataset: String,
    /// By what.
    pub metric: &'static MetricEntry,
    /// The parameters of the metric.
    pub metric_params: ParamMap,
    /// How classes are matched.
    pub classes: ClassMatching,
    /// Number of bootstrap resamples for the interval of the headline; 0 leaves it out.
    pub resamples: usize,
    /// The folder where every answer is written as it comes, and in the end the report and its pictures; an evaluation
    /// that was broken off goes on from there.
    pub folder: Option<&'a Path>,
    /// What is broken is left out and listed, or ends the evaluation.
    pub problems: &'a Problems,
    /// To whom to report; asked whether to stop.
    pub progress: &'a dyn Progress,
}

impl<'a> Evaluation<'a> {
    /// A silent evaluation that writes nothing.
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
        }
    }

    /// Runs loaded `learners` of one kind over the data set: as many samples at once as there
    /// are learners, sequences by the first alone.
    ///
    /// When the user stops it, the outcome is of what was done, and says so.
    ///
    /// # Errors
    /// `InvalidInput` when data set, learner and metric do not fit together; for a broken sample, unless problems are
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

    /// Runs predictors that take `ports`, as [`Evaluation::run`] runs learners; `classes` are what their class numbers mean, as far
    /// as their predictions do not say it. Thresholds stay as they are.
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

    /// Where answers are ranked, those of a low score belong into the ranking, too: a threshold that the user left as it
    /// is made low for the evaluation. What it was.
    fn lower_threshold(&self, learners: &mut [Box<dyn AnyLearner>]) -> Result<Option<ParamValue>> {
        let Some(first) = learners.first().filter(|_| self.metric.ranks) else { return Ok(None) };
        let Some(was) = first.params().remove(THRESHOLD) else { return Ok(None) };
        if first.default_of(THRESHOLD).as_ref() != Some(&was)
            || was.as_float().is_none_or(|was| was <= LOW_THRESHOLD)
        {
            return Ok(None);
        }
        let low = ParamValue::Float(LOW_THRESHOLD);
        learners.iter_mut().try_for_each(|learner| learner.set(THRESHOLD, low.clone()))?;
        self.progress.note(&format!(
            "threshold {LOW_THRESHOLD} instead of {was}: {} ranks answers of every score",
            self.metric.name
        ));
        Ok(Some(was))
    }

    /// Counts answers that somebody wrote down.
    ///
    /// # Errors
    /// As [`Evaluation::run`].
    pub fn score(&self, answers: &Answers, dataset: &dyn DatasetIterator) -> Result<Outcome> {
        let begun = Instant::now();
        let mut tally = self.begin(dataset, answers.classes())?;
        let done = (0..dataset.len()).take_while(|_| !self.progress.stopped()).try_for_each(|at| {
            let answer = answers.get(at, self.metric.prediction);
            self.progress.advance(1);
            tally.count(Line { at, name: dataset.name(at), answer: Answer::of(answer, dataset, at) })
        });
        self.progress.end();
        done?;
        if let Some(folder) = self.folder {
            fs::create_dir_all(folder).context(|| format!("making {}", folder.display()))?;
        }
        self.finish(tally, begun, |_| 0.0)
    }

    fn begin<'d>(&self, dataset: &'d dyn DatasetIterator, learner: Classes) -> Result<Tally<'d>>
    where
        'a: 'd,
    {
        let AnnotatedClasses { classes, occurring } = annotated_classes(dataset, self.metric.truth);
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
            shown: Shown::new(SHOWN, dataset.len()),
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
        let (worst, evenly) = tally.shown.into_samples();
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
            worst,
            evenly,
            problems: self.problems.list(),
            written: Vec::new(),
        };
        let least = describe(&mut outcome);
        if let Some(folder) = self.folder {
            outcome.write(tally.dataset, folder, least)?;
        }
        Ok(outcome)
    }

    /// Every parameter of the metric as it was used.
    fn metric_settings(&self) -> ParamMap {
        let defaults = self.metric.params.iter().map(|field| (field.name.to_owned(), field.default.value()));
        defaults.chain(self.metric_params.clone()).collect()
    }

    /// Counts what the journal tells of.
    fn resume(&self, tally: &mut Tally<'_>) -> Result<Option<Journal>> {
        let Some(folder) = self.folder else { return Ok(None) };
        fs::create_dir_all(folder).context(|| format!("making {}", folder.display()))?;
        let dataset = tally.dataset;
        let heading = Heading::new(self.subject.clone(), self.dataset.clone(), dataset);
        let journal = Journal::resume(&folder.join(JOURNAL), &heading, dataset, |line| {
            self.progress.advance(1);
            tally.count(line)
        })?;
        if tally.next > 0 && tally.next < dataset.len() {
            self.progress.note(&format!("going on after {} of {} samples", tally.next, dataset.len()));
        }
        Ok(Some(journal))
    }

    /// Predicts the samples that are left.
    fn predict<P: Predictor>(
        &self,
        predictors: &mut [P],
        ports: &[Port],
        tally: &mut Tally<'_>,
        mut journal: Option<Journal>,
    ) -> Result<()> {
        let (dataset, first) = (tally.dataset, tally.next);
        let wanted = self.metric.prediction;
        predict_samples(predictors, ports, dataset, first, wanted, self.progress, |line| {
            if let Some(journal) = &mut journal {
                journal.write(&line)?;
            }
            tally.count(line)
        })
    }
}

/// What was counted so far.
struct Tally<'a> {
    groups: Groups,
    /// The sample or sequence that is counted.
    unit: usize,
    in_sequences: bool,
    /// Classes of the data set that are annotated.
    occurring: Option<Vec<usize>>,
    classes: ClassMap,
    shown: Shown,
    /// The sample that comes next.
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
                self.shown.add(&AnsweredSample { index: at, name: dataset.name(at), score, prediction });
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
        let mut prediction = match line.answer {
            Answer::Prediction(prediction) => *prediction,
            Answer::Error(problem) => return Err(problem),
        };
        let mapped = self.classes.apply(&mut prediction);
        let counted = mapped.and_then(|()| dataset.target(at)).and_then(|truth| {
            let truth =
                truth.ok_or_else(|| Error::invalid_input("the sample has no annotation to compare with"))?;
            self.groups.of(self.unit).update(at, (&prediction).into(), (&truth).into())
        });
        match counted {
            Ok(score) => Ok((score, prediction)),
            Err(error) => Err(Problem::of(&error, dataset, at)),
        }
    }
}

/// The number of independent samples: sequences where samples are frames of some; and whether they are.
fn units_of(dataset: &dyn DatasetIterator) -> (usize, bool) {
    if dataset.is_empty() || dataset.sequence(0).is_none() {
        return (dataset.len(), false);
    }
    let begins = |at: &usize| *at == 0 || dataset.sequence(*at) != dataset.sequence(at - 1);
    ((0..dataset.len()).filter(begins).count(), true)
}
