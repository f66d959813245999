//! The trait of all training algorithms, and their report.

use std::ops::ControlFlow;
use std::path::PathBuf;

use opendr_engine::environment::{Info, Snapshot};
use opendr_engine::{Error, ErrorKind, Result, ResultExt as _};
use opendr_runlog::{Checkpoint, Checkpoints};
use opendr_simulation::vector::VecEnvironment;

use crate::episodes::Episodes;
use crate::policy::Policy;
use crate::saved_state::SavedState;

/// Progress and statistics of a training.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    /// Steps of all environments together.
    pub timesteps: u64,
    /// Episodes that ended.
    pub episodes: u64,
    /// Mean return of the last 100 episodes.
    pub mean_return: Option<f64>,
    /// Mean length of the last 100 episodes, in steps.
    pub mean_length: Option<f64>,
    /// Success rate over those of the last 100 episodes whose final info has `success`.
    pub success_rate: Option<f64>,
    /// Losses and other statistics of the last update, under the names of Stable-Baselines3; empty before the first.
    pub metrics: Info,
}

/// Argument of the observer of [`Algorithm::train`], after each iteration.
pub struct IterationEvent<'a, A> {
    /// The learner, e.g. to evaluate its policy.
    pub learner: &'a A,
    /// Its environments, e.g. to save a checkpoint.
    pub environments: &'a dyn VecEnvironment,
    /// Progress and statistics so far.
    pub report: &'a Report,
}

/// A training algorithm: it collects steps in environments and updates a policy.
///
/// A training is a loop of [`iterate`](Self::iterate), by [`train`](Self::train) or by the caller. Between two iterations it can be
/// saved. A resumed training gives the same result bit for bit, with any number of threads.
pub trait Algorithm {
    /// Name of the algorithm, such as `ppo`.
    fn name(&self) -> &'static str;

    /// Returns the current policy.
    fn policy(&self) -> &Policy;

    /// Starts from a policy, e.g. an imported one or one cloned from demonstrations. Critics keep their parameters.
    ///
    /// # Errors
    /// `InvalidInput` when its spaces, head or networks differ from those of this algorithm.
    fn set_policy(&mut self, policy: &Policy) -> Result<()>;

    /// Returns progress and statistics.
    fn report(&self) -> &Report;

    /// Collects steps and updates the policy from them. `total_timesteps` is the length of the whole training, for
    /// schedules.
    ///
    /// # Errors
    /// `InvalidInput` for environments of other spaces or without [`Autoreset::SameStep`](opendr_simulation::vector::Autoreset), and
    /// for observations and rewards that are not finite; `Internal` when learning diverges. The message contains the time step.
    fn iterate(&mut self, environments: &mut dyn VecEnvironment, total_timesteps: u64) -> Result<&Report>;

    /// Returns the state of the training. Environments without snapshots are not part of it; their episodes restart.
    ///
    /// # Errors
    /// `InvalidInput` before the first iteration.
    fn saved_state(&self, environments: &dyn VecEnvironment) -> Result<SavedState>;

    /// Restores a state, in environments of the same kind and number.
    ///
    /// # Errors
    /// `InvalidInput` and `Format` for a state of another training; the algorithm must not be used afterwards.
    fn restore(&mut self, state: &SavedState, environments: &mut dyn VecEnvironment) -> Result<()>;

    /// Names of the arrays in a saved state.
    fn array_names(&self) -> &'static [&'static str];

    /// Saves a checkpoint of this step. Returns its folder.
    ///
    /// # Errors
    /// As [`Self::saved_state`], and `Io` when the disk is full; other checkpoints stay untouched.
    fn save(&self, checkpoints: &Checkpoints, environments: &dyn VecEnvironment) -> Result<PathBuf> {
        self.save_with(checkpoints, environments, Vec::new())
    }

    /// Saves a checkpoint with additional files.
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

    /// Resumes from the newest intact checkpoint and returns it; none if there is no checkpoint.
    ///
    /// # Errors
    /// `NotFound` for checkpoints of another algorithm, `Integrity` when all are damaged, and as [`Self::restore`].
    fn load(
        &mut self,
        checkpoints: &Checkpoints,
        environments: &mut dyn VecEnvironment,
    ) -> Result<Option<Checkpoint>> {
        let Some(checkpoint) = checkpoints.latest()? else { return Ok(None) };
        SavedState::from_files(&|name| checkpoint.file(name), self.array_names())
            .and_then(|state| self.restore(&state, environments))
            .context(|| format!("resuming from {}", checkpoint.path().display()))?;
        Ok(Some(checkpoint))
    }

    /// Trains until `total_timesteps` steps are taken, or until `observer` breaks; it is called after each iteration. A
    /// later call resumes the training.
    ///
    /// # Errors
    /// As [`Self::iterate`], and those of the observer.
    fn train(
        &mut self,
        environments: &mut dyn VecEnvironment,
        total_timesteps: u64,
        observer: &mut dyn FnMut(IterationEvent<'_, Self>) -> Result<ControlFlow<()>>,
    ) -> Result<&Report>
    where
        Self: Sized,
    {
        while self.report().timesteps < total_timesteps {
            self.iterate(environments, total_timesteps)?;
            let event =
                IterationEvent { learner: &*self, environments: &*environments, report: self.report() };
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
    Error::invalid_input(format!(
        "the training of {name} has no state before the first iteration; call iterate once"
    ))
}

/// Returns the states of environments; for those without snapshots, a snapshot with an empty name.
pub(crate) fn snapshot_of(environments: &dyn VecEnvironment) -> Result<Snapshot> {
    match environments.snapshot() {
        Err(error) if error.kind() == ErrorKind::Unsupported => Ok(Snapshot::new("")),
        snapshot => snapshot.map_err(|error| error.context("saving the state of a training")),
    }
}

/// Returns the error for a loss or gradient that is not finite.
pub(crate) fn diverged(what: &str, number: f64, timesteps: u64) -> Error {
    Error::internal(format!(
        "{what} is {number} at time step {timesteps}: learning diverged; lower learning_rate, or normalise rewards"
    ))
}
