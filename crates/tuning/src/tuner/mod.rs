//! Tuning of trainings.

mod plan;
mod training;

use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use opendr_engine::params::ParamMap;
use opendr_engine::{Error, Result, ResultExt};
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::pruner::Advice;
use crate::records::{StudyRecord, TrialState};
use crate::space::SearchSpace;
use crate::study::{Budget, Outcome, Progress, Reevaluation, Study, Trial};

pub use plan::Plan;
pub use training::Training;

/// Starts a training with these parameters and this seed.
type Begin<'a> = Box<dyn Fn(&ParamMap, u64) -> Result<Box<dyn Training + 'a>> + Sync + 'a>;

/// Whether a tuning is complete.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TuningStatus {
    /// The budget of trials is used up.
    Finished,
    /// It was stopped, or its time is over. The running trials wait and are resumed first.
    Interrupted,
}

/// Tunes the hyperparameters of trainings that run in pieces.
///
/// A trial trains its configuration with the first seed and is evaluated at the points of the [`Plan`]; there a
/// pruner may stop or pause it, and a paused one resumes from its checkpoint if it is promoted. A trial that reaches
/// the end is trained with the other seeds in turn, and its value, the mean, counts only after the last. A step of
/// a trial's reports is a unit of training, counted over the seeds: a whole training with `k` seeds ends at
/// `k * length`, so that [`Asha`](crate::Asha) rungs beyond the length decide which trials get further seeds.
///
/// The state of every training is saved at every point. Threads share the study, processes its journal and this folder;
/// each process may be killed at any time and loses only its work since the last point.
pub struct Tuner<'a> {
    study: Study,
    space: SearchSpace,
    plan: Plan,
    folder: PathBuf,
    begin: Begin<'a>,
}

/// Progress of a trial, as stored in its checkpoint.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
struct TrialProgress {
    /// Values of the finished seeds.
    values: Vec<f64>,
    /// Units done with the current seed.
    done: u64,
}

/// Observes the study after every evaluation, and stops a run early.
struct Watch<'w> {
    watch: &'w (dyn Fn(&StudyRecord, usize) -> Progress + Sync),
    end: Option<Instant>,
    stopped: AtomicBool,
}

impl Watch<'_> {
    /// Calls the observer. Returns whether to stop.
    fn look(&self, study: &StudyRecord, number: usize) -> bool {
        if (self.watch)(study, number) == Progress::Stop {
            self.stop();
        }
        self.stopped()
    }

    fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed) || self.end.is_some_and(|end| Instant::now() >= end)
    }
}

impl<'a> Tuner<'a> {
    /// Creates a tuner with its checkpoints in `folder`, which is for this study only and is created if missing.
    ///
    /// # Errors
    /// `InvalidParam` for a study of several directions.
    pub fn new<T: Training + 'a>(
        study: Study,
        space: SearchSpace,
        plan: Plan,
        folder: impl Into<PathBuf>,
        begin: impl Fn(&ParamMap, u64) -> Result<T> + Sync + 'a,
    ) -> Result<Self> {
        if study.inspect(|study| study.directions.len()) != 1 {
            return Err(Error::invalid_param(
                "the tuner evaluates trainings by one number; give one direction",
            ));
        }
        let begin: Begin<'a> = Box::new(move |params, seed| Ok(Box::new(begin(params, seed)?)));
        Ok(Self { study, space, plan, folder: folder.into(), begin })
    }

    /// Returns the study.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Runs trials until the budget is used up. `watch` is called with the study and the number of a trial after every
    /// evaluation, for instance to print a table. Once it returns [`Progress::Stop`], or the budget's time is over, all trials wait at
    /// their next point, and nothing is lost. A training that is stopped earlier, as by Ctrl-C, resumes from its last point.
    ///
    /// # Errors
    /// As [`Study::optimize`].
    pub fn run(
        &self,
        budget: &Budget,
        watch: impl Fn(&StudyRecord, usize) -> Progress + Sync,
    ) -> Result<TuningStatus> {
        let watch = Watch { watch: &watch, end: budget.end(), stopped: AtomicBool::new(false) };
        let objective = |trial: &Trial<'_>| self.carry_out(trial, &watch);
        self.study.optimize(&self.space, budget, objective, |study, number| {
            // The last evaluation has already been reported, a failure has not.
            let failed = study.trials.get(number).is_some_and(|trial| trial.state == TrialState::Failed);
            let stop = if failed { watch.look(study, number) } else { watch.stopped() };
            if stop { Progress::Stop } else { Progress::Continue }
        })?;
        Ok(if watch.stopped() { TuningStatus::Interrupted } else { TuningStatus::Finished })
    }

    /// Trains the best configuration again, with seeds that did not select it, and stores the result in the
    /// study, since the value of the best of many is biased. Returns none when a training was stopped.
    ///
    /// # Errors
    /// `InvalidParam` without a complete trial; the errors of the learner; `Io` and `Format` of the storage.
    pub fn reevaluate(&self) -> Result<Option<Reevaluation>> {
        self.study.reevaluate_best(&self.plan.fresh_seeds, |trial, seed| {
            let mut training = (self.begin)(&trial.param_map()?, seed)?;
            training.advance(self.plan.length())
        })
    }

    fn carry_out(&self, trial: &Trial<'_>, watch: &Watch<'_>) -> Result<Outcome> {
        let params = trial.param_map()?;
        let mut progress = match trial.resumed_from() {
            Some(state) => TrialProgress::deserialize(state).map_err(|error| {
                Error::format(format!("trial {} has no checkpoint of this tuner", trial.number()))
                    .with_source(error)
            })?,
            None => TrialProgress::default(),
        };
        for (at, seed) in self.plan.seeds.iter().enumerate().skip(progress.values.len()) {
            let folder = self.folder_of(trial.number()).join(format!("seed_{at}"));
            let mut training = (self.begin)(&params, *seed)?;
            if progress.done > 0 {
                training.load(&folder).context(|| format!("resuming trial {}", trial.number()))?;
            }
            let before = progress.done;
            for point in self.plan.points.iter().filter(|point| **point > before) {
                let Some(value) = training.advance(*point)? else {
                    watch.stop();
                    return Ok(Outcome::Interrupted(json!(progress)));
                };
                if !value.is_finite() {
                    return Ok(Outcome::Failed(format!(
                        "the evaluation gave {value} after {point}, with seed {seed}"
                    )));
                }
                fs::create_dir_all(self.folder_of(trial.number()))
                    .context(|| format!("creating {}", self.folder_of(trial.number()).display()))?;
                training.save(&folder)?;
                match *point == self.plan.length() {
                    true => {
                        progress.values.push(value);
                        progress.done = 0;
                    }
                    false => progress.done = *point,
                }
                if let Some(outcome) = self.report_value(trial, &progress, value, watch)? {
                    return Ok(outcome);
                }
            }
        }
        Ok(Outcome::from(mean(&progress.values)))
    }

    /// Reports the value of the configuration. Returns the outcome of the trial; none if it continues.
    fn report_value(
        &self,
        trial: &Trial<'_>,
        progress: &TrialProgress,
        value: f64,
        watch: &Watch<'_>,
    ) -> Result<Option<Outcome>> {
        let last = progress.values.len() == self.plan.seeds.len();
        // Until it is finished, a further seed is less informative than the finished ones.
        let advice = match (progress.values.len(), progress.done) {
            (0, done) => trial.report(done as i64, value)?,
            (seeds, 0) => trial.report((seeds as u64 * self.plan.length()) as i64, mean(&progress.values))?,
            _ => Advice::Continue,
        };
        // After the report: a process that dies between the two repeats both with the same result.
        trial.checkpoint(json!(progress))?;
        let stop = self.study.inspect(|study| watch.look(study, trial.number()));
        Ok(match advice {
            _ if last => None,
            Advice::Pause => Some(Outcome::Paused(json!(progress))),
            Advice::Stop => {
                let folder = self.folder_of(trial.number());
                fs::remove_dir_all(&folder).context(|| format!("removing {}", folder.display()))?;
                Some(Outcome::Pruned)
            }
            Advice::Continue if stop => Some(Outcome::Interrupted(json!(progress))),
            Advice::Continue => None,
        })
    }

    /// Returns the folder of a trial's checkpoints.
    pub fn folder_of(&self, number: usize) -> PathBuf {
        self.folder.join(format!("trial_{number}"))
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

#[cfg(test)]
mod tests;
