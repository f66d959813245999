//! Hyperparameter search for any learner: for its training, or for the parameters of inference.

mod data;
mod learner_training;
mod measured_learner;
mod options;
mod search;
mod tuned;
mod until;

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use opendr_engine::learner::Entry;
use opendr_engine::params::ParamMap;
use opendr_engine::{Error, Progress, Result, ResultExt as _, Unit};
use opendr_runlog::{svg_from_figure, write_atomically};
use opendr_tuning::{
    Asha, Budget, Direction, Hyperband, Median, NoPruner, Plan, Progress as Going, Storage, Study,
    StudyRecord, Tpe, Training, TrialState, Tuner, TuningStatus, history_figure, importance_figure,
    importance_from_study,
};

pub use data::{MakeLearner, TuneData};
pub use learner_training::LearnerTraining;
use measured_learner::MeasuredLearner;
pub use options::TuneOptions;
pub use search::search_space;
pub use tuned::Tuned;

/// Name of the study in the output folder, a journal that Optuna reads.
pub const STUDY_JOURNAL: &str = "study.log";
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
        TuneData::Dataset { .. } => entry.capabilities.fit && !entry.capabilities.fit_in,
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
    let study = Study::open(Storage::journal(output.join(STUDY_JOURNAL))?, entry.spec.name, &[direction])?
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
