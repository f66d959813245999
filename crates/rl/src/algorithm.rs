//! What all learners of this crate have in common.

use std::ops::ControlFlow;
use std::path::PathBuf;

use opendr_engine::environment::{Info, Snapshot};
use opendr_engine::{Error, ErrorKind, Result, ResultExt as _};
use opendr_runlog::{Checkpoint, Checkpoints};
use opendr_simulation::vector::VecEnvironment;

use crate::episodes::Episodes;
use crate::policy::Policy;
use crate::saved_state::SavedState;

/// How a training goes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    /// Steps of all environments together.
    pub timesteps: u64,
    /// Episodes that ended.
    pub episodes: u64,
    /// The mean return of the last hundred.
    pub mean_return: Option<f64>,
    /// Their mean length.
    pub mean_length: Option<f64>,
    /// The share of successes among those whose infos tell.
    pub success_rate: Option<f64>,
    /// Losses and the like of the last update, by the names of Stable-Baselines3; empty before one.
    pub metrics: Info,
}

/// What an observer of a training sees after each iteration.
pub struct Event<'a, A> {
    /// The learner, e.g. to evaluate its policy.
    pub learner: &'a A,
    /// Its environments, e.g. to save a checkpoint.
    pub environments: &'a dyn VecEnvironment,
    /// How the training goes.
    pub report: &'a Report,
}

/// A learner: it acts in environments and changes its policy.
///
/// A training is a loop of [`iterate`](Self::iterate), by [`train`](Self::train) or by the caller; between two iterations it can be
/// saved, and goes on later, elsewhere, with any number of threads, with the same bits.
pub trait Algorithm {
    /// Its name: `ppo`.
    fn name(&self) -> &'static str;

    /// What it has learnt.
    fn policy(&self) -> &Policy;

    /// Begins from a policy, e.g. one that was imported or cloned from demonstrations; values are still to be learnt.
    ///
    /// # Errors
    /// `InvalidInput` when it sees, acts or is made otherwise.
    fn set_policy(&mut self, policy: &Policy) -> Result<()>;

    /// How the training goes.
    fn report(&self) -> &Report;

    /// Acts for some steps and learns from them. `total_timesteps` is the length of the whole training, on which
    /// schedules depend.
    ///
    /// # Errors
    /// `InvalidInput` for environments of another kind, or not with [`Autoreset::SameStep`](opendr_simulation::vector::Autoreset), and
    /// for observations and rewards that are not finite; `Internal` when learning diverges. The message has the step.
    fn iterate(&mut self, environments: &mut dyn VecEnvironment, total_timesteps: u64) -> Result<&Report>;

    /// Everything that decides the future; but environments without snapshots begin their episodes anew.
    ///
    /// # Errors
    /// `InvalidInput` before the first iteration.
    fn saved_state(&self, environments: &dyn VecEnvironment) -> Result<SavedState>;

    /// Goes back to a state, in environments of the same kind and number.
    ///
    /// # Errors
    /// `InvalidInput` and `Format` for a state of something else; the learner is then not to be used.
    fn restore(&mut self, state: &SavedState, environments: &mut dyn VecEnvironment) -> Result<()>;

    /// The long rows of numbers in its state.
    fn rows(&self) -> &'static [&'static str];

    /// Saves a checkpoint of this step, and gives its folder.
    ///
    /// # Errors
    /// As [`Self::saved_state`], and `Io` when the disk is full: the other checkpoints are untouched then.
    fn save(&self, checkpoints: &Checkpoints, environments: &dyn VecEnvironment) -> Result<PathBuf> {
        self.save_with(checkpoints, environments, Vec::new())
    }

    /// The same with further files in the checkpoint.
    ///
    /// # Errors
    /// As [`Self::save`].
    fn save_with(
        &self,
        checkpoints: &Checkpoints,
        environments: &dyn VecEnvironment,
        further: Vec<(String, Vec<u8>)>,
    ) -> Result<PathBuf> {
        let mut files = self.saved_state(environments)?.files()?;
        files.extend(further);
        let files: Vec<_> = files.iter().map(|(name, bytes)| (name.as_str(), &bytes[..])).collect();
        checkpoints.save(self.report().timesteps, &files)
    }

    /// Goes on from the newest checkpoint that is whole, and gives it; none where there is none.
    ///
    /// # Errors
    /// `NotFound` for the checkpoints of another learner, `Integrity` where all are broken, and as [`Self::restore`].
    fn load(
        &mut self,
        checkpoints: &Checkpoints,
        environments: &mut dyn VecEnvironment,
    ) -> Result<Option<Checkpoint>> {
        let Some(checkpoint) = checkpoints.latest()? else { return Ok(None) };
        SavedState::from_files(&|name| checkpoint.file(name), self.rows())
            .and_then(|state| self.restore(&state, environments))
            .context(|| format!("resuming from {}", checkpoint.path().display()))?;
        Ok(Some(checkpoint))
    }

    /// Trains until `total_timesteps` steps were taken, or `observer`, asked after each iteration, breaks off. A
    /// training that was broken off, or loaded, goes on.
    ///
    /// # Errors
    /// As [`Self::iterate`], and those of the observer.
    fn train(
        &mut self,
        environments: &mut dyn VecEnvironment,
        total_timesteps: u64,
        observer: &mut dyn FnMut(Event<'_, Self>) -> Result<ControlFlow<()>>,
    ) -> Result<&Report>
    where
        Self: Sized,
    {
        while self.report().timesteps < total_timesteps {
            self.iterate(environments, total_timesteps)?;
            let event = Event { learner: &*self, environments: &*environments, report: self.report() };
            if observer(event)?.is_break() {
                break;
            }
        }
        Ok(self.report())
    }
}

impl Report {
    pub(crate) fn count(&mut self, timesteps: u64, episodes: &Episodes) {
        self.timesteps = timesteps;
        self.episodes = episodes.count();
        self.mean_return = episodes.mean_return();
        self.mean_length = episodes.mean_length();
        self.success_rate = episodes.success_rate();
    }
}

pub(crate) fn not_begun(name: &str) -> Error {
    Error::invalid_input(format!("{name} has not begun; iterate once before its state is saved"))
}

/// The states of environments; of those that keep none, a snapshot without a name, from which they begin anew.
pub(crate) fn snapshot_of(environments: &dyn VecEnvironment) -> Result<Snapshot> {
    match environments.snapshot() {
        Err(error) if error.kind() == ErrorKind::Unsupported => Ok(Snapshot::new("")),
        snapshot => snapshot.map_err(|error| error.context("saving the state of a training")),
    }
}

/// The error of a loss or gradient that is not finite.
pub(crate) fn diverged(what: &str, number: f64, timesteps: u64) -> Error {
    Error::internal(format!(
        "{what} is {number} at time step {timesteps}: learning diverged; lower learning_rate, or normalise rewards"
    ))
}
