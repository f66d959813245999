//! Trials of trainings.

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

/// Begins a training with these parameters and this seed.
type Begin<'a> = Box<dyn Fn(&ParamMap, u64) -> Result<Box<dyn Training + 'a>> + Sync + 'a>;

/// Whether a tuning came to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Tuning {
    /// Its budget of trials is used up.
    Finished,
    /// It was stopped, or its time is over. The trials that were being carried out wait, and go on first.
    Interrupted,
}

/// Tunes whatever can be trained in pieces: a learner of control as well as one of perception.
///
/// A trial trains its configuration with the first seed, and is measured on the way, at the points of the [`Plan`]; there a
/// pruner may stop or pause it, and a paused one goes on from its checkpoint when it turns out to be worth it. What comes to
/// the end is trained with the other seeds, one after the other, and counts, with the mean, only after the last. A step of
/// a trial's reports is a unit of training, counted over the seeds: a whole training with `k` seeds ends at
/// `k * length`, so that [`Asha`](crate::Asha) rungs beyond the length decide who gets further seeds.
///
/// The state of every training is saved at every point. Threads share the study, processes its journal and this folder;
/// each may be killed at any moment, and loses what it did since the last point.
pub struct Tuner<'a> {
    study: Study,
    space: SearchSpace,
    plan: Plan,
    folder: PathBuf,
    begin: Begin<'a>,
}

/// Where a trial stands, as its checkpoint says it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
struct Stand {
    /// What the seeds came to that are done.
    values: Vec<f64>,
    /// Units done with the next.
    done: u64,
}

/// Who sees the study after every measurement, and what ends a run early.
struct Watch<'w> {
    watch: &'w (dyn Fn(&StudyRecord, usize) -> Progress + Sync),
    end: Option<Instant>,
    stopped: AtomicBool,
}

impl Watch<'_> {
    /// Shows the study. Whether this is the end.
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
    /// A tuner that keeps checkpoints in `folder`, which is the study's alone, and is made when there is none.
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
            return Err(Error::invalid_param("a training is measured by one number: give one direction"));
        }
        let begin: Begin<'a> = Box::new(move |params, seed| Ok(Box::new(begin(params, seed)?)));
        Ok(Self { study, space, plan, folder: folder.into(), begin })
    }

    /// The study.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Carries out trials until the budget is used up. `watch` sees the study, and the number of a trial, after every
    /// measurement, as for a live table; once it says [`Progress::Stop`], or the budget's time is over, all trials wait at
    /// their next point, and nothing is lost. A training that is stopped before, as after Ctrl-C, goes on from its last.
    ///
    /// # Errors
    /// As [`Study::optimize`].
    pub fn run(
        &self,
        budget: &Budget,
        watch: impl Fn(&StudyRecord, usize) -> Progress + Sync,
    ) -> Result<Tuning> {
        let watch = Watch { watch: &watch, end: budget.end(), stopped: AtomicBool::new(false) };
        let objective = |trial: &Trial<'_>| self.carry_out(trial, &watch);
        self.study.optimize(&self.space, budget, objective, |study, number| {
            // What was measured last was shown already; what failed was not.
            let failed = study.trials.get(number).is_some_and(|trial| trial.state == TrialState::Failed);
            let stop = if failed { watch.look(study, number) } else { watch.stopped() };
            if stop { Progress::Stop } else { Progress::Continue }
        })?;
        Ok(if watch.stopped() { Tuning::Interrupted } else { Tuning::Finished })
    }

    /// Trains the best configuration anew, with seeds by which it was not chosen, and notes what came of it beside the
    /// study: what was chosen as the best of many is not that good again. None when a training was stopped.
    ///
    /// # Errors
    /// `InvalidParam` when no trial is complete; those of the learner; `Io` and `Format` of the storage.
    pub fn reevaluate(&self) -> Result<Option<Reevaluation>> {
        self.study.reevaluate_best(&self.plan.fresh_seeds, |trial, seed| {
            let mut training = (self.begin)(&trial.param_map()?, seed)?;
            training.advance(self.plan.length())
        })
    }

    fn carry_out(&self, trial: &Trial<'_>, watch: &Watch<'_>) -> Result<Outcome> {
        let params = trial.param_map()?;
        let mut stand = match trial.resumed_from() {
            Some(state) => Stand::deserialize(state).map_err(|error| {
                Error::format(format!("trial {} has no checkpoint of this tuner", trial.number()))
                    .with_source(error)
            })?,
            None => Stand::default(),
        };
        for (at, seed) in self.plan.seeds.iter().enumerate().skip(stand.values.len()) {
            let folder = self.folder_of(trial.number()).join(format!("seed_{at}"));
            let mut training = (self.begin)(&params, *seed)?;
            if stand.done > 0 {
                training.load(&folder).context(|| format!("going on with trial {}", trial.number()))?;
            }
            let before = stand.done;
            for point in self.plan.points.iter().filter(|point| **point > before) {
                let Some(value) = training.advance(*point)? else {
                    watch.stop();
                    return Ok(Outcome::Interrupted(json!(stand)));
                };
                if !value.is_finite() {
                    return Ok(Outcome::Failed(format!(
                        "it measured {value} after {point}, with seed {seed}"
                    )));
                }
                fs::create_dir_all(self.folder_of(trial.number()))
                    .context(|| format!("making {}", self.folder_of(trial.number()).display()))?;
                training.save(&folder)?;
                match *point == self.plan.length() {
                    true => {
                        stand.values.push(value);
                        stand.done = 0;
                    }
                    false => stand.done = *point,
                }
                if let Some(outcome) = self.judged(trial, &stand, value, watch)? {
                    return Ok(outcome);
                }
            }
        }
        Ok(Outcome::from(mean(&stand.values)))
    }

    /// Reports what stands for the configuration, and what is to be done: nothing, where it goes on.
    fn judged(
        &self,
        trial: &Trial<'_>,
        stand: &Stand,
        value: f64,
        watch: &Watch<'_>,
    ) -> Result<Option<Outcome>> {
        let last = stand.values.len() == self.plan.seeds.len();
        // Between its ends, a further seed says less than those before have said.
        let advice = match (stand.values.len(), stand.done) {
            (0, done) => trial.report(done as i64, value)?,
            (seeds, 0) => trial.report((seeds as u64 * self.plan.length()) as i64, mean(&stand.values))?,
            _ => Advice::Continue,
        };
        // After the report: whoever dies between the two measures, and reports, the same again.
        trial.checkpoint(json!(stand))?;
        let stop = self.study.inspect(|study| watch.look(study, trial.number()));
        Ok(match advice {
            _ if last => None,
            Advice::Pause => Some(Outcome::Paused(json!(stand))),
            Advice::Stop => {
                let folder = self.folder_of(trial.number());
                fs::remove_dir_all(&folder).context(|| format!("removing {}", folder.display()))?;
                Some(Outcome::Pruned)
            }
            Advice::Continue if stop => Some(Outcome::Interrupted(json!(stand))),
            Advice::Continue => None,
        })
    }

    /// Where the trainings of a trial are saved.
    pub fn folder_of(&self, number: usize) -> PathBuf {
        self.folder.join(format!("trial_{number}"))
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

#[cfg(test)]
mod tests;
