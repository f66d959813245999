//! `tune` of any learner: of its training, or of its own parameters.

mod learner_training;
mod measured_learner;
mod search;
mod tuned;
mod until;

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use opendr_engine::dataset::DatasetRef;
use opendr_engine::environment::EnvironmentSource;
use opendr_engine::learner::{AnyLearner, Entry};
use opendr_engine::params::ParamMap;
use opendr_engine::{Device, Error, Progress, Result, ResultExt as _, Unit};
use opendr_evaluation::EvalOptions;
use opendr_rl::EvaluationProtocol;
use opendr_runlog::{svg_from_figure, write_atomically};
use opendr_tuning::{
    Asha, Budget, Direction, Hyperband, Median, NoPruner, Plan, Progress as Going, Storage, Study,
    StudyRecord, Tpe, Training, TrialState, Tuner, Tuning, history_figure, importance_figure,
    importance_from_study,
};

pub use learner_training::LearnerTraining;
use measured_learner::MeasuredLearner;
pub use search::search_space;
pub use tuned::Tuned;

/// What configurations are trained and measured on.
#[derive(Clone, Copy)]
pub enum TuneData<'a> {
    /// Policies: in environments, measured by the share of successes where there is one, else by the mean return.
    Environment {
        /// Makes those to act in.
        env: &'a dyn EnvironmentSource,
        /// On which episodes they are measured.
        protocol: &'a EvaluationProtocol,
    },
    /// Learners of a data set, measured by the headline of their task's metric on another part.
    Dataset {
        /// To train on.
        dataset: DatasetRef<'a>,
        /// To measure on.
        val_dataset: DatasetRef<'a>,
        /// The part to train on.
        split: Option<&'a str>,
        /// The part to measure on.
        val_split: Option<&'a str>,
    },
    /// Learners as they are, of which nothing is trained: their own parameters, measured on a data set.
    Answers {
        /// Makes a loaded learner of these parameters.
        make: &'a MakeLearner<'a>,
        /// To measure on.
        dataset: DatasetRef<'a>,
        /// The part to measure on.
        split: Option<&'a str>,
        /// What to measure by; by default the task's own metric.
        metric: Option<&'a str>,
    },
}

/// Makes a loaded learner of the parameters of a trial, and of those that stay.
pub type MakeLearner<'a> = dyn Fn(&ParamMap) -> Result<Box<dyn AnyLearner>> + Sync + 'a;

/// How configurations are searched.
#[derive(Debug, Clone, PartialEq)]
pub struct TuneOptions {
    /// Parameters of the training, or of the learner as it is, as `NAME`, `NAME=LOW..HIGH` or `NAME=A,B,C`.
    pub search: Vec<String>,
    /// Parameters of the training that stay.
    pub fit_params: ParamMap,
    /// Parameters of the learner.
    pub params: ParamMap,
    /// Configurations in all, those of earlier calls counted.
    pub trials: usize,
    /// Seeds of each configuration that comes to the end.
    pub seeds: usize,
    /// Steps of a whole training.
    pub length: u64,
    /// Steps between two measurements.
    pub interval: u64,
    /// `"asha"`, `"median"`, `"hyperband"` or `"none"`.
    pub pruner: String,
    /// Trials at a time.
    pub jobs: usize,
    /// No trial is begun after this time.
    pub timeout: Option<Duration>,
    /// What fixes everything random.
    pub seed: u64,
    /// Where to train.
    pub device: Device,
}

/// The file of the study in the output folder, a journal that Optuna reads.
const STUDY: &str = "study.log";
/// The folder of trials in the output folder.
const TRIALS: &str = "trials";
/// The folder of trainings that are under way in the output folder.
const WORK: &str = "work";

/// Tunes the training of a learner of `entry`, or the learner as it is; everything is kept in `output`, where a later call goes
/// on. A learner that is not trained answers the same every time: its trials have no points, pruner and seeds.
///
/// `watch` sees the study, and the number of a trial, after every measurement.
///
/// # Errors
/// `Unsupported` when the learner does not train so; `InvalidParam` for parameters that there are not; those of trainings
/// where several fail in a row; `Io`.
pub fn tune(
    entry: &'static Entry,
    data: TuneData<'_>,
    options: &TuneOptions,
    output: &Path,
    watch: &(dyn Fn(&StudyRecord, usize) + Sync),
    progress: &dyn Progress,
) -> Result<Tuned> {
    let begun = Instant::now();
    let able = match data {
        TuneData::Environment { .. } => entry.capabilities.fit_in,
        TuneData::Dataset { .. } => entry.capabilities.fit,
        TuneData::Answers { .. } => true,
    };
    if !able {
        let class = entry.spec.class;
        return Err(Error::unsupported(format!("{class} does not train so; nothing can be tuned")));
    }
    std::fs::create_dir_all(output).context(|| format!("making {}", output.display()))?;
    let trains = !matches!(data, TuneData::Answers { .. });
    let fields = if trains { entry.fit_params } else { entry.params };
    let space = match search_space(fields, &options.search) {
        Err(error) if !entry.capabilities.fit => {
            let class = entry.spec.class;
            return Err(error.context(format!("{class} does not train, so its own parameters are searched")));
        }
        space => space?,
    };
    let study = study(entry, data, options, output)?;
    let plan = match trains {
        true => Plan::every(options.interval, options.length)?.with_seeds(options.seed, options.seeds),
        false => Plan::every(1, 1)?.with_seeds(options.seed, 1),
    };
    let begin = |trial: &ParamMap, seed: u64| -> Result<Box<dyn Training + '_>> {
        if let TuneData::Answers { make, dataset, .. } = data {
            let params =
                options.params.iter().chain(trial).map(|(name, value)| (name.clone(), value.clone()));
            let (params, options) = (params.collect(), data.eval_options());
            return Ok(Box::new(MeasuredLearner { entry, make, params, dataset, options, progress }));
        }
        let work = output.join(WORK);
        Ok(Box::new(LearnerTraining::new(entry, data, options, trial, seed, &work, progress)?))
    };
    let tuner = Tuner::new(study, space, plan, output.join(TRIALS), begin)?;
    let mut budget = Budget::total(options.trials).threads(options.jobs);
    if let Some(timeout) = options.timeout {
        budget = budget.timeout(timeout);
    }
    progress.begin(entry.spec.name, Some(options.trials as u64), Unit::Items);
    let known = AtomicUsize::new(0);
    let ended = tuner.run(&budget, |study, number| {
        let trials = study.trials.iter().filter(|trial| trial.state != TrialState::Failed).count();
        progress.advance(trials.saturating_sub(known.fetch_max(trials, Ordering::Relaxed)) as u64);
        watch(study, number);
        if progress.stopped() { Going::Stop } else { Going::Continue }
    });
    progress.end();
    let ended = ended?;
    let best = tuner.study().best();
    let finished = ended == Tuning::Finished && best.is_some();
    let again = if finished && trains { tuner.reevaluate()? } else { None };
    // Empty but for what a killed process left there.
    std::fs::remove_dir(output.join(WORK)).ok();
    for (name, figure) in [
        ("history.svg", tuner.study().inspect(history_figure)),
        ("importance.svg", tuner.study().inspect(importance_figure)),
    ] {
        write_atomically(&output.join(name), svg_from_figure(&figure).1.as_bytes())?;
    }
    Ok(Tuned {
        learner: entry.spec.name.to_owned(),
        params: best
            .as_ref()
            .map(|best| best.params.iter().map(|(name, it)| (name.clone(), it.value())).collect()),
        value: best.and_then(|best| best.value()),
        complete: finished && (again.is_some() || !trains),
        fresh_values: again.map(|again| again.values).unwrap_or_default(),
        importance: tuner.study().inspect(importance_from_study).into_iter().collect(),
        trials: tuner.study().inspect(|study| study.trials.len()),
        seconds: begun.elapsed().as_secs_f64(),
        output: output.to_owned(),
    })
}

fn study(entry: &Entry, data: TuneData<'_>, options: &TuneOptions, output: &Path) -> Result<Study> {
    let by_error = match data {
        TuneData::Environment { .. } => false,
        TuneData::Dataset { .. } | TuneData::Answers { .. } => {
            let metric = data.eval_options().metric_for(entry)?;
            metric.is_error(metric.numbers[0].0)
        }
    };
    let direction = if by_error { Direction::Minimize } else { Direction::Maximize };
    let study = Study::open(Storage::journal(output.join(STUDY))?, entry.spec.name, &[direction])?
        .with_sampler(Tpe::new(options.seed));
    if let TuneData::Answers { .. } = data {
        return Ok(study.with_pruner(NoPruner));
    }
    let (first, last) = (options.interval as i64, (options.length * options.seeds as u64) as i64);
    Ok(match options.pruner.as_str() {
        "asha" => study.with_pruner(Asha::new(first, 3)?),
        "median" => study.with_pruner(Median::default()),
        "hyperband" => study.with_pruner(Hyperband::new(first, last, 3)?),
        "none" => study.with_pruner(NoPruner),
        other => {
            return Err(Error::invalid_param(format!(
                "no pruner {other:?}; there are asha, median, hyperband and none"
            )));
        }
    })
}

impl TuneData<'_> {
    /// How what was made of a data set is measured.
    fn eval_options(&self) -> EvalOptions {
        let (split, metric) = match *self {
            Self::Environment { .. } => (None, None),
            Self::Dataset { val_split, .. } => (val_split, None),
            Self::Answers { split, metric, .. } => (split, metric),
        };
        let [split, metric] = [split, metric].map(|name| name.map(str::to_owned));
        EvalOptions { split, metric, resamples: Some(0), ..EvalOptions::default() }
    }
}

fn nothing_measured(name: &str) -> Error {
    Error::invalid_input(format!("there is no {name} on these data: is anything annotated?"))
}
