//! Hyperparameter search for any learner: for its training, or for the parameters of inference.

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
    StudyRecord, Tpe, Training, TrialState, Tuner, TuningStatus, history_figure, importance_figure,
    importance_from_study,
};

pub use learner_training::LearnerTraining;
use measured_learner::MeasuredLearner;
pub use search::search_space;
pub use tuned::Tuned;

/// Data on which configurations are trained and evaluated.
#[derive(Clone, Copy)]
pub enum TuneData<'a> {
    /// Policies in environments, evaluated by the success rate if there is one, else by the mean return.
    Environment {
        /// Source of the environments.
        env: &'a dyn EnvironmentSource,
        /// Episodes of the evaluation.
        protocol: &'a EvaluationProtocol,
    },
    /// Learners of a data set, evaluated by the main value of their task's metric on another split.
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
    /// Learners without training: their own parameters, evaluated on a data set.
    Inference {
        /// Loads a learner with the given parameters.
        make: &'a MakeLearner<'a>,
        /// To measure on.
        dataset: DatasetRef<'a>,
        /// The part to measure on.
        split: Option<&'a str>,
        /// Metric (default: that of the task).
        metric: Option<&'a str>,
    },
}

/// Loads a learner with the parameters of a trial and the fixed ones.
pub type MakeLearner<'a> = dyn Fn(&ParamMap) -> Result<Box<dyn AnyLearner>> + Sync + 'a;

/// Options of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct TuneOptions {
    /// Parameters to search, of the training or of the learner, as `NAME`, `NAME=LOW..HIGH` or `NAME=A,B,C`.
    pub search: Vec<String>,
    /// Fixed parameters of the training.
    pub fit_params: ParamMap,
    /// Fixed parameters of the learner.
    pub params: ParamMap,
    /// Total number of configurations, including those of earlier calls.
    pub trials: usize,
    /// Number of seeds of each configuration that completes.
    pub seeds: usize,
    /// Steps of a complete training.
    pub steps: u64,
    /// Steps between two evaluations.
    pub interval: u64,
    /// Pruner: `"asha"`, `"median"`, `"hyperband"` or `"none"`.
    pub pruner: String,
    /// Number of trials that run in parallel.
    pub jobs: usize,
    /// Time after which no trial starts.
    pub timeout: Option<Duration>,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Device of the trainings.
    pub device: Device,
}

/// Name of the study in the output folder, a journal that Optuna reads.
const STUDY: &str = "study.log";
/// Name of the folder of trials in the output folder.
const TRIALS: &str = "trials";
/// Name of the folder of running trainings in the output folder.
const WORK: &str = "work";

/// Tunes the training of a learner of `entry`, or its inference. The study is kept in `output`, where a later call resumes it. A
/// learner without training is deterministic: its trials have no intermediate evaluations, pruner or seeds.
///
/// `watch` receives the study and the index of a trial after every evaluation.
///
/// # Errors
/// `Unsupported` when the learner does not train on such data; `InvalidParam` for unknown parameters; those of trainings, if
/// several fail in a row; `Io`.
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
        TuneData::Inference { .. } => true,
    };
    if !able {
        let class = entry.spec.class;
        return Err(Error::unsupported(format!(
            "{class} does not train on such data and cannot be tuned on them"
        )));
    }
    std::fs::create_dir_all(output).context(|| format!("creating {}", output.display()))?;
    let trains = !matches!(data, TuneData::Inference { .. });
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
        true => Plan::every(options.interval, options.steps)?.with_seeds(options.seed, options.seeds),
        false => Plan::every(1, 1)?.with_seeds(options.seed, 1),
    };
    let begin = |trial: &ParamMap, seed: u64| -> Result<Box<dyn Training + '_>> {
        if let TuneData::Inference { make, dataset, .. } = data {
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
    let finished = ended == TuningStatus::Finished && best.is_some();
    let again = if finished && trains { tuner.reevaluate()? } else { None };
    // Fails if a killed process left files there, which is fine.
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
        TuneData::Dataset { .. } | TuneData::Inference { .. } => {
            let metric = data.eval_options().metric_for(entry)?;
            metric.is_lower_better(metric.numbers[0].0)
        }
    };
    let direction = if by_error { Direction::Minimize } else { Direction::Maximize };
    let study = Study::open(Storage::journal(output.join(STUDY))?, entry.spec.name, &[direction])?
        .with_sampler(Tpe::new(options.seed));
    if let TuneData::Inference { .. } = data {
        return Ok(study.with_pruner(NoPruner));
    }
    let (first, last) = (options.interval as i64, (options.steps * options.seeds as u64) as i64);
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
    /// Returns the evaluation options of a trial on a data set.
    fn eval_options(&self) -> EvalOptions {
        let (split, metric) = match *self {
            Self::Environment { .. } => (None, None),
            Self::Dataset { val_split, .. } => (val_split, None),
            Self::Inference { split, metric, .. } => (split, metric),
        };
        let [split, metric] = [split, metric].map(|name| name.map(str::to_owned));
        EvalOptions { split, metric, resamples: Some(0), ..EvalOptions::default() }
    }
}

fn nothing_measured(name: &str) -> Error {
    Error::invalid_input(format!("there is no value of {name} on these data; check that they are annotated"))
}
