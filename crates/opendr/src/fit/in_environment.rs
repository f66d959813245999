//! Training of policies.

use std::time::Instant;

use opendr_datasets::Problems;
use opendr_engine::dataset::{DatasetIterator as _, DatasetRef, Subset};
use opendr_engine::environment::EnvironmentSource;
use opendr_engine::learner::{AnyLearner, Entry, FitJob};
use opendr_engine::{Error, Progress, Result, Statistics};
use opendr_evaluation::DatasetOpener;

use super::check::check_fit;
use super::data::FitData;
use super::fitted::Fitted;
use super::options::FitOptions;
use super::run_folder;
use crate::training_environment;

/// Environments in which a policy is trained and evaluated.
#[derive(Clone, Copy)]
pub struct FitEnvironments<'a> {
    /// Source of the training environments.
    pub env: &'a dyn EnvironmentSource,
    /// Source of the evaluation environments (default: `env`).
    pub val_env: Option<&'a dyn EnvironmentSource>,
}

/// Trains a policy in environments, from its model if one is loaded, loads the result, and writes a report beside it.
///
/// When the user stops the training, the model is that of the steps so far, and [`Fitted::complete`] is false.
///
/// # Errors
/// `Unsupported` when the learner does not train in environments; `InvalidParam` for a wrong parameter or an option of
/// data sets; `InvalidInput` when the output folder is not empty, or the policy has other spaces; `Io`; those of the
/// environment, with the step.
pub fn fit_policy(
    learner: &mut dyn AnyLearner,
    entry: &'static Entry,
    environments: FitEnvironments<'_>,
    options: &FitOptions,
    progress: &dyn Progress,
) -> Result<Fitted> {
    check_options(options, false)?;
    let FitEnvironments { env, val_env } = environments;
    let fitted = fit_with(learner, entry, options, progress, |learner, job| {
        learner.fit_in(&options.params, env, val_env, job)
    })?;
    fitted.finish(progress)
}

/// Trains a policy on demonstrations, a data set of its own format. Validation data measure the error of its actions.
///
/// # Errors
/// As [`fit_policy`], and errors of the data set.
pub(super) fn fit_demonstrations(
    learner: &mut dyn AnyLearner,
    entry: &'static Entry,
    data: FitData<'_>,
    options: &FitOptions,
    progress: &dyn Progress,
) -> Result<Fitted> {
    let FitData { dataset, val_dataset, teacher, group } = data;
    if group.is_some() {
        return Err(Error::unsupported("a policy learns in one process, not in a group of several"));
    }
    if teacher.is_some() {
        return Err(Error::unsupported("a policy learns from demonstrations, not from another learner"));
    }
    check_options(options, true)?;
    let external = options.val_dataset();
    let val_dataset = val_dataset.or(external.as_ref().map(DatasetRef::External));
    let fitted = fit_with(learner, entry, options, progress, |learner, job| {
        learner.fit(&options.params, dataset, val_dataset, job)
    })?;
    Fitted { dataset: options.dataset_name(dataset), ..fitted }.finish(progress)
}

/// Trains a learner of active perception: perception on a data set, and the camera motion in environments from `env`.
///
/// # Errors
/// As [`fit_policy`], and errors of the data set.
pub fn fit_active(
    learner: &mut dyn AnyLearner,
    entry: &'static Entry,
    dataset: DatasetRef<'_>,
    env: &dyn EnvironmentSource,
    options: &FitOptions,
    progress: &dyn Progress,
) -> Result<Fitted> {
    let problems = Problems::new(options.skip_broken);
    let opener = DatasetOpener::new(entry, true, &problems, progress);
    let samples = opener.open_training(dataset, options.split.as_deref())?;
    let samples = Subset::first(samples, options.limit.unwrap_or(usize::MAX));
    let fitted = fit_with(learner, entry, options, progress, |learner, job| {
        let dataset = DatasetRef::Iterator(&samples);
        learner.fit_active(&options.params, Some(dataset), env, job)
    })?;
    let fitted = Fitted {
        dataset: options.dataset_name(dataset),
        samples: samples.len(),
        skipped: problems.count(),
        problems: problems.list(),
        ..fitted
    };
    fitted.finish(progress)
}

/// Trains by `train`, and returns what is to be reported.
fn fit_with(
    learner: &mut dyn AnyLearner,
    entry: &'static Entry,
    options: &FitOptions,
    progress: &dyn Progress,
    train: impl FnOnce(&mut dyn AnyLearner, &FitJob<'_>) -> Result<Statistics>,
) -> Result<Fitted> {
    let begun = Instant::now();
    if !entry.capabilities.fit_in {
        let class = entry.spec.class;
        return Err(Error::unsupported(format!(
            "{class} trains on data sets; give a data set instead of an environment"
        )));
    }
    check_fit(entry, &options.params)?;
    let output = options.output_folder(entry.spec.name)?;
    run_folder::check(&output, options.resume)?;
    run_folder::make(&output)?;
    progress.note(&format!("output: {}", output.display()));
    let job = FitJob {
        output: &output,
        resume: options.resume,
        logging_path: options.logging_path.as_deref(),
        device: learner.device(),
        skip_broken: false,
        progress,
        group: None,
    };
    let statistics = match progress.stopped() {
        true => Statistics::default(),
        false => train(learner, &job)?,
    };
    Ok(Fitted {
        learner: entry.spec.name.to_owned(),
        environment: Some(training_environment(learner).unwrap_or_default().to_owned()),
        dataset: String::new(),
        samples: 0,
        complete: !progress.stopped(),
        seconds: begun.elapsed().as_secs_f64(),
        statistics,
        model: Some(job.model()).filter(|model| model.exists()),
        logging_path: options.logging_path.clone(),
        skipped: 0,
        problems: Vec::new(),
        output,
    })
}

/// Refuses options that apply to data sets of samples only; demonstrations may have validation data.
fn check_options(options: &FitOptions, may_validate: bool) -> Result<()> {
    let FitOptions { split, val, val_format, val_split, limit, teacher, .. } = options;
    let given = [
        ("split", split.is_some()),
        ("val", val.is_some() && !may_validate),
        ("val_format", val_format.is_some() && !may_validate),
        ("val_split", val_split.is_some()),
        ("limit", limit.is_some()),
        ("teacher", teacher.is_some()),
    ];
    match given.into_iter().find(|(_, given)| *given) {
        Some((name, _)) => Err(Error::invalid_param(format!(
            "{name} applies to data sets only; omit it for a policy that trains in an environment"
        ))),
        None => Ok(()),
    }
}
