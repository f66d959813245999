//! Training of a learner as a trial of a tuner.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use opendr_engine::learner::{AnyLearner, Entry};
use opendr_engine::params::{ParamMap, ParamValue};
use opendr_engine::{Error, Progress, Result, ResultExt as _, Silent};
use opendr_tuning::Training;

use super::data::nothing_measured;
use super::until::Until;
use super::{TuneData, TuneOptions};
use crate::{FitData, FitEnvironments, FitOptions, PolicyController, evaluate_policy, fit, fit_policy};

/// Training of one configuration with one seed, which stops with a checkpoint at each evaluation and resumes.
pub struct LearnerTraining<'a> {
    entry: &'static Entry,
    data: TuneData<'a>,
    learner: Box<dyn AnyLearner>,
    params: ParamMap,
    folder: PathBuf,
    progress: &'a dyn Progress,
}

static COUNTER: AtomicU64 = AtomicU64::new(0);

/// Names of the parameters that set the length of a training.
const LENGTH: [&str; 2] = ["total_timesteps", "max_steps"];
const SEED: &str = "seed";
const MEASUREMENTS: &str = "eval_freq";

impl<'a> LearnerTraining<'a> {
    /// Creates a training that has not begun, with a folder of its own below `work`.
    ///
    /// # Errors
    /// `InvalidParam` for wrong parameters, `Unsupported` for [`TuneData::Inference`], which trains nothing.
    pub fn new(
        entry: &'static Entry,
        data: TuneData<'a>,
        options: &TuneOptions,
        trial: &ParamMap,
        seed: u64,
        work: &Path,
        progress: &'a dyn Progress,
    ) -> Result<Self> {
        if matches!(data, TuneData::Inference { .. }) {
            return Err(Error::unsupported(
                "these data are for the evaluation of a learner without training",
            ));
        }
        let mut params = options.fit_params.clone();
        let has = |name: &str| entry.fit_params.iter().any(|field| field.is_called(name));
        params.extend(
            LENGTH
                .into_iter()
                .filter(|name| has(name))
                .map(|name| (name.to_owned(), (options.steps as i64).into())),
        );
        if has(SEED) {
            params.insert(SEED.to_owned(), (seed as i64).into());
        }
        if has(MEASUREMENTS) {
            params.insert(MEASUREMENTS.to_owned(), ParamValue::Int(0));
        }
        params.extend(trial.clone());
        let number = COUNTER.fetch_add(1, Ordering::Relaxed);
        let folder = work.join(format!("{}-{number}", std::process::id()));
        fs::remove_dir_all(&folder).ok();
        let learner = entry.make(&options.params, options.device)?;
        Ok(Self { entry, data, learner, params, folder, progress })
    }

    /// Trains up to step `until` and returns whether the training got there.
    fn train(&mut self, until: u64) -> Result<bool> {
        let options = FitOptions {
            params: self.params.clone(),
            out: Some(self.folder.clone()),
            resume: self.folder.exists(),
            ..FitOptions::default()
        };
        let until = Until::new(self.progress, until);
        match self.data {
            TuneData::Environment { env, .. } => {
                let environments = FitEnvironments { env, val_env: None };
                fit_policy(self.learner.as_mut(), self.entry, environments, &options, &until)
            }
            TuneData::Dataset { dataset, split, .. } | TuneData::Inference { dataset, split, .. } => {
                let options = FitOptions { split: split.map(str::to_owned), ..options };
                fit(self.learner.as_mut(), self.entry, FitData::from(dataset), &options, &until)
            }
        }
        .map(|_| !self.progress.stopped())
    }

    fn measure(&mut self) -> Result<f64> {
        match self.data {
            TuneData::Environment { env, protocol } => {
                let mut environment = env.make()?;
                let mut acting =
                    PolicyController::new(self.learner.stream()?, self.entry, environment.spec())?;
                let report = evaluate_policy(&mut acting, environment.as_mut(), protocol, &Silent)?;
                Ok(report.success.map_or(report.mean_return, |success| success.rate))
            }
            TuneData::Dataset { val_dataset: dataset, .. } | TuneData::Inference { dataset, .. } => {
                let options = self.data.eval_options();
                let outcome = options.run(&mut self.learner, self.entry, dataset, &Silent)?;
                let (name, _) = options.metric_for(self.entry)?.numbers[0];
                outcome.report.statistics.get(name).ok_or_else(|| nothing_measured(name))
            }
        }
    }
}

impl Training for LearnerTraining<'_> {
    fn advance(&mut self, until: u64) -> Result<Option<f64>> {
        if !self.train(until)? {
            return Ok(None);
        }
        self.measure().map(Some)
    }

    fn save(&self, folder: &Path) -> Result<()> {
        copied(&self.folder, folder)
    }

    fn load(&mut self, folder: &Path) -> Result<()> {
        copied(folder, &self.folder)
    }
}

impl Drop for LearnerTraining<'_> {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// Copies a folder atomically: the copy is complete or absent.
fn copied(from: &Path, to: &Path) -> Result<()> {
    let context = || format!("copying {} to {}", from.display(), to.display());
    let number = COUNTER.fetch_add(1, Ordering::Relaxed);
    let beside = to.with_extension(format!("partial-{}-{number}", std::process::id()));
    copy(from, &beside).context(context)?;
    fs::remove_dir_all(to).ok();
    fs::rename(&beside, to).context(context)
}

fn copy(from: &Path, to: &Path) -> std::io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        match entry.file_type()?.is_dir() {
            true => copy(&entry.path(), &target)?,
            false => fs::copy(entry.path(), target).map(drop)?,
        }
    }
    Ok(())
}
