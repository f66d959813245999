//! `tune` of any learner that trains.

mod learner_training;
mod search;
mod tuned;
mod until;

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use opendr_engine::dataset::DatasetRef;
use opendr_engine::environment::EnvironmentSource;
use opendr_engine::learner::Entry;
use opendr_engine::params::ParamMap;
use opendr_engine::{Device, Error, Progress, Result, ResultExt as _, Unit};
use opendr_rl::EvaluationProtocol;
use opendr_runlog::{svg_from_figure, write_atomically};
use opendr_tuning::{
    Asha, Budget, Direction, Hyperband, Median, NoPruner, Plan, Progress as Going, Storage, Study,
    StudyRecord, Tpe, TrialState, Tuner, Tuning, history_figure, importance_figure, importance_from_study,
};

pub use learner_training::LearnerTraining;
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
}

/// How configurations are searched.
#[derive(Debug, Clone, PartialEq)]
pub struct TuneOptions {
    /// Parameters of the training, as `NAME`, `NAME=LOW..HIGH` or `NAME=A,B,C`.
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

/// Tunes the training of a learner of `entry`; everything is kept in `output`, where a later call goes on.
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
    };
    if !able {
        let class = entry.spec.class;
        return Err(Error::unsupported(format!("{class} does not train so; nothing can be tuned")));
    }
    std::fs::create_dir_all(output).context(|| format!("making {}", output.display()))?;
    let space = search_space(entry.fit_params, &options.search)?;
    let study = study(entry, data, options, output)?;
    let plan = Plan::every(options.interval, options.length)?.with_seeds(options.seed, options.seeds);
    let begin = |params: &ParamMap, seed: u64| {
        LearnerTraining::new(entry, data, options, params, seed, &output.join(WORK), progress)
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
    let again = match ended == Tuning::Finished && best.is_some() {
        true => tuner.reevaluate()?,
        false => None,
    };
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
        complete: again.is_some(),
        fresh_values: again.map(|again| again.values).unwrap_or_default(),
        importance: tuner.study().inspect(importance_from_study).into_iter().collect(),
        trials: tuner.study().inspect(|study| study.trials.len()),
        seconds: begun.elapsed().as_secs_f64(),
        output: output.to_owned(),
    })
}

fn study(entry: &Entry, data: TuneData<'_>, options: &TuneOptions, output: &Path) -> Result<Study> {
    let direction = match data {
        TuneData::Dataset { .. } if learner_training::measured_by_error(entry)? => Direction::Minimize,
        _ => Direction::Maximize,
    };
    let study = Study::open(Storage::journal(output.join(STUDY))?, entry.spec.name, &[direction])?
        .with_sampler(Tpe::new(options.seed));
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
