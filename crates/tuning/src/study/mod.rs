//! Studies with an ask-and-tell interface.

mod claim;
mod optimize;
mod outcome;
mod seeds;
mod trial;

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use opendr_engine::{Error, Result};
use serde_json::{Map, Value};

use crate::pruner::{Advice, NoPruner, Pruner};
use crate::records::{Direction, StudyRecord, TrialRecord, TrialState};
use crate::sampler::{Sampler, Tpe};
use crate::storage::{NewTrial, Notes, Operation, Replay, Storage};
use crate::{Distribution, Timestamp};

pub use optimize::{Budget, Progress};
pub use outcome::Outcome;
pub use seeds::{Reevaluation, fresh_seeds, training_seeds};
pub use trial::Trial;

/// System attribute with the time of a running trial's last sign of life, in microseconds since 1970.
const ALIVE: &str = "opendr:alive";
/// Optuna's system attribute with the parameters of a queued trial.
const FIXED: &str = "fixed_params";

/// A hyperparameter search with an ask-and-tell interface. Threads may share a study, and processes its
/// storage.
///
/// ```
/// use opendr_tuning::{Direction, Distribution, Outcome, SearchSpace, Storage, Study};
///
/// # fn main() -> opendr_engine::Result<()> {
/// let study = Study::open(Storage::memory(), "parabola", &[Direction::Minimize])?;
/// let space = SearchSpace::new().with("x", Distribution::float(-5.0, 5.0)?)?;
/// for _ in 0..40 {
///     let trial = study.ask(&space)?;
///     let x = trial.float("x")?;
///     trial.tell(Outcome::from((x - 1.0) * (x - 1.0)))?;
/// }
/// let best = study.best().expect("forty trials are complete");
/// assert!(best.value() < Some(0.1));
/// # Ok(())
/// # }
/// ```
pub struct Study {
    storage: Mutex<Storage>,
    id: usize,
    sampler: Box<dyn Sampler>,
    pruner: Box<dyn Pruner>,
    abandoned_after: Option<Duration>,
}

impl Study {
    /// Opens the study `name`, or creates it, with [`Tpe`] of seed 0 and no pruner.
    ///
    /// # Errors
    /// `InvalidParam` without a direction, or when the existing study has others; `Io` and `Format` of the storage.
    pub fn open(mut storage: Storage, name: &str, directions: &[Direction]) -> Result<Self> {
        if directions.is_empty() {
            return Err(Error::invalid_param(format!(
                "study {name:?} has no directions; give one for each value of the objective"
            )));
        }
        let named =
            |replay: &Replay| replay.studies().find(|(_, study)| study.name == name).map(|(id, _)| id);
        storage.transact(|replay, _| {
            let create = || Operation::CreateStudy { name: name.to_owned(), directions: directions.to_vec() };
            Ok(if named(replay).is_none() { vec![create()] } else { Vec::new() })
        })?;
        let id = named(storage.replay())
            .ok_or_else(|| Error::internal(format!("study {name:?} was not created")))?;
        let known = storage.replay().study(id).map(|study| study.directions.clone()).unwrap_or_default();
        if known != directions {
            return Err(Error::invalid_param(format!(
                "study {name:?} has the directions {known:?}, not {directions:?}; give the same directions, or another name"
            )));
        }
        let (sampler, pruner) = (Box::new(Tpe::new(0)), Box::new(NoPruner));
        Ok(Self { storage: Mutex::new(storage), id, sampler, pruner, abandoned_after: None })
    }

    /// Sets the sampler.
    #[must_use]
    pub fn with_sampler(mut self, sampler: impl Sampler + 'static) -> Self {
        self.sampler = Box::new(sampler);
        self
    }

    /// Sets the pruner.
    #[must_use]
    pub fn with_pruner(mut self, pruner: impl Pruner + 'static) -> Self {
        self.pruner = Box::new(pruner);
        self
    }

    /// Treats the worker of a running trial as dead after this time without a report. By default only workers of this machine
    /// are recognised as dead, by their processes; those of other machines, of Optuna, and from before a restart are not.
    #[must_use]
    pub fn with_abandoned_after(mut self, time: Duration) -> Self {
        self.abandoned_after = Some(time);
        self
    }

    /// Adds a trial with these parameters to the queue; missing ones are drawn when it starts.
    ///
    /// # Errors
    /// `Io` and `Format` of the storage.
    pub fn enqueue(&self, params: &BTreeMap<String, Value>) -> Result<()> {
        let fixed: Map<_, _> = params.iter().map(|(name, value)| (name.clone(), value.clone())).collect();
        self.write(|_| {
            let mut trial = NewTrial::new(TrialState::Waiting);
            trial.system_attributes.insert(FIXED.to_owned(), Value::Object(fixed));
            Ok(vec![Operation::CreateTrial { study: self.id, trial: Box::new(trial) }])
        })
    }

    /// Reports the value of trial `number` at `step`. Returns the pruner's decision.
    ///
    /// # Errors
    /// `InvalidParam` when the trial is not running here, or the study has several directions; `Io` and `Format` of the
    /// storage.
    pub fn report(&self, number: usize, step: i64, value: f64) -> Result<Advice> {
        self.write_of(number, |study, trial| {
            if study.directions.len() != 1 {
                return Err(Error::invalid_param("intermediate reports need a study with one direction"));
            }
            let report = Operation::Report { trial: trial.id, step, value };
            Ok([report].into_iter().chain(self.sign_of_life(trial)).collect())
        })?;
        let storage = self.storage();
        let study = self.record(&storage)?;
        let trial = study.trials.get(number).ok_or_else(|| no_trial(number))?;
        Ok(self.pruner.advice(study, trial))
    }

    /// Sets a user attribute of trial `number`.
    ///
    /// # Errors
    /// `InvalidParam` when the trial is not running here; `Io` and `Format` of the storage.
    pub fn set_user_attribute(&self, number: usize, key: &str, value: Value) -> Result<()> {
        self.write_of(number, |_, trial| {
            Ok(vec![Operation::NoteOfTrial {
                trial: trial.id,
                notes: Notes::User,
                key: key.to_owned(),
                value,
            }])
        })
    }

    /// Saves the state from which trial `number` resumes if its worker dies.
    ///
    /// # Errors
    /// As [`Study::set_user_attribute`].
    pub fn checkpoint(&self, number: usize, state: Value) -> Result<()> {
        self.write_of(number, |_, trial| Ok(vec![outcome::checkpoint(trial, state)]))
    }

    /// Sets a user attribute of the study.
    ///
    /// # Errors
    /// `Io` and `Format` of the storage.
    pub fn set_study_attribute(&self, key: &str, value: Value) -> Result<()> {
        let key = key.to_owned();
        self.write(|_| Ok(vec![Operation::NoteOfStudy { study: self.id, notes: Notes::User, key, value }]))
    }

    /// Ends or pauses trial `number` with an outcome.
    ///
    /// # Errors
    /// `InvalidParam` when the trial is not running here, for instance because its worker was treated as dead, or the number of values
    /// differs from that of the directions; `Io` and `Format` of the storage.
    pub fn tell(&self, number: usize, outcome: Outcome) -> Result<()> {
        self.write_of(number, |study, trial| outcome.operations(study, trial))
    }

    /// Prunes all paused trials. Until then, a resumed study may continue them.
    ///
    /// # Errors
    /// `Io` and `Format` of the storage.
    pub fn prune_paused(&self) -> Result<()> {
        self.write(|study| {
            let paused = study.trials.iter().filter(|trial| trial.is_paused());
            Ok(paused.flat_map(|trial| outcome::prune(study, trial)).collect())
        })
    }

    /// Returns a copy of the study's record, as this process has read it.
    pub fn snapshot(&self) -> StudyRecord {
        self.inspect(StudyRecord::clone)
    }

    /// Calls `look` with the study's record, as this process has read it. The study is locked meanwhile.
    pub fn inspect<T>(&self, look: impl FnOnce(&StudyRecord) -> T) -> T {
        let storage = self.storage();
        match self.record(&storage) {
            Ok(study) => look(study),
            // Another process deleted the study.
            Err(_) => look(&StudyRecord {
                name: String::new(),
                directions: vec![Direction::Minimize],
                trials: Vec::new(),
                user_attributes: BTreeMap::new(),
                system_attributes: BTreeMap::new(),
            }),
        }
    }

    /// Reads changes by other processes.
    ///
    /// # Errors
    /// `Io` and `Format` of the storage.
    pub fn refresh(&self) -> Result<()> {
        self.storage().refresh()
    }

    /// Returns the complete trial with the best value.
    pub fn best(&self) -> Option<TrialRecord> {
        self.inspect(|study| study.best().cloned())
    }

    fn storage(&self) -> MutexGuard<'_, Storage> {
        // A panic elsewhere leaves the storage consistent: whole operations change it.
        self.storage.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn record<'a>(&self, storage: &'a Storage) -> Result<&'a StudyRecord> {
        storage.replay().study(self.id).ok_or_else(|| Error::not_found("the study has been deleted"))
    }

    fn write(&self, decide: impl FnOnce(&StudyRecord) -> Result<Vec<Operation>>) -> Result<()> {
        self.storage().transact(|replay, _| {
            decide(replay.study(self.id).ok_or_else(|| Error::not_found("the study has been deleted"))?)
        })
    }

    /// Writes operations of a trial that this process runs.
    fn write_of(
        &self,
        number: usize,
        decide: impl FnOnce(&StudyRecord, &TrialRecord) -> Result<Vec<Operation>>,
    ) -> Result<()> {
        self.storage().transact(|replay, worker| {
            let study = replay.study(self.id).ok_or_else(|| Error::not_found("the study has been deleted"))?;
            let trial = study.trials.get(number).ok_or_else(|| no_trial(number))?;
            if trial.state != TrialState::Running || trial.worker != worker {
                return Err(Error::invalid_param(format!(
                    "trial {number} is not running here, it is {:?}; another process may have treated this one as dead",
                    trial.state
                )));
            }
            decide(study, trial)
        })
    }

    /// Returns a sign of life of a trial, four times as often as needed.
    fn sign_of_life(&self, trial: &TrialRecord) -> Option<Operation> {
        let (now, every) = (Timestamp::now(), self.abandoned_after? / 4);
        let due = last_sign(trial).is_none_or(|last| now.since(last) >= every);
        let (notes, key) = (Notes::System, ALIVE.to_owned());
        due.then(|| Operation::NoteOfTrial { trial: trial.id, notes, key, value: now.0.into() })
    }
}

/// Returns the last sign of life of a trial.
fn last_sign(trial: &TrialRecord) -> Option<Timestamp> {
    let alive = trial.system_attributes.get(ALIVE).and_then(Value::as_i64).map(Timestamp);
    alive.max(trial.started)
}

fn no_trial(number: usize) -> Error {
    Error::not_found(format!("the study has no trial {number}"))
}

/// Checks that `distribution` is compatible with those of earlier trials.
fn check_compatible(study: &StudyRecord, name: &str, distribution: &Distribution) -> Result<()> {
    let known = study.trials.iter().find_map(|trial| trial.params.get(name));
    match known {
        Some(known) if !known.distribution.is_compatible(distribution) => Err(Error::invalid_param(format!(
            "parameter {name:?} is {distribution}, but in earlier trials of study {:?} it was {}: ranges may change, kind, scale \
             and choices may not; begin another study",
            study.name, known.distribution
        ))),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests;
