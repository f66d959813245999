//! Reinforcement-learning environments with the semantics of Gymnasium 1.x.

mod controller;
mod environment_source;
mod info;
mod snapshot;
mod space;
mod spec;
mod tracking;

use crate::data::Image;
use crate::{Error, Result};

pub use controller::Controller;
pub use environment_source::EnvironmentSource;
pub use info::Info;
pub use snapshot::{Snapshot, StateReader};
pub use space::{Dtype, Space};
pub use spec::EnvironmentSpec;
pub use tracking::{TrackingAxis, TrackingLayout, TrackingTask};

/// Options of a reset, e.g. `low` and `high` of the initial state.
pub type ResetOptions = crate::params::ParamMap;

/// Reward and end of a step. The observation is in the buffer of the caller.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Step {
    /// The reward.
    pub reward: f64,
    /// Whether the task ended (goal, crash); the state after it has no value.
    pub terminated: bool,
    /// Whether the episode was cut (time limit); the state after it still has a value.
    pub truncated: bool,
    /// Additional results of the step.
    pub info: Info,
}

impl Step {
    /// Returns whether the episode is over; the next call must be a reset.
    pub fn is_over(&self) -> bool {
        self.terminated || self.truncated
    }
}

/// An environment: `reset`, then `step` until it is terminated or truncated.
///
/// Observations and actions are flat slices of numbers in the layout of their [`Space`], in buffers of the caller: a step
/// allocates nothing.
pub trait Environment: Send {
    /// Returns name, spaces and limits.
    fn spec(&self) -> &EnvironmentSpec;

    /// Starts an episode and writes its first observation. A seed determines all random numbers until the next seed. Without
    /// a seed the random generator continues; that of a new environment is seeded at random.
    ///
    /// # Errors
    /// Returns `InvalidInput` if `observation` does not have the length of the space, `InvalidParam` for invalid options.
    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info>;

    /// Performs one step and writes the next observation.
    ///
    /// # Errors
    /// Returns `InvalidInput` if the action is outside its space, before the first reset, and after the end of an episode.
    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step>;

    /// Writes the complete state, including the random generator.
    ///
    /// # Errors
    /// Returns `Unsupported` if the environment has no snapshots.
    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        let _ = snapshot;
        Err(Error::unsupported(format!("{} does not support snapshots", self.spec().id)))
    }

    /// Reads the state that [`Self::save_state`] wrote, in the same order.
    ///
    /// # Errors
    /// Returns `Unsupported` if the environment has no snapshots, `Format` if the snapshot does not fit.
    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let _ = state;
        Err(Error::unsupported(format!("{} does not support snapshots", self.spec().id)))
    }

    /// Returns an image of the current state, if the environment renders.
    ///
    /// # Errors
    /// Returns `InvalidInput` before the first reset.
    fn render(&mut self) -> Result<Option<Image>> {
        Ok(None)
    }

    /// Returns a snapshot of the current state: for planning, exact replay and checkpoints.
    ///
    /// # Errors
    /// As [`Self::save_state`].
    fn snapshot(&self) -> Result<Snapshot> {
        let mut snapshot = Snapshot::new(&self.spec().id);
        self.save_state(&mut snapshot)?;
        Ok(snapshot)
    }

    /// Restores a state: the same actions then have the same results, bit for bit.
    ///
    /// # Errors
    /// Returns `InvalidInput` for a snapshot of another environment; otherwise as [`Self::load_state`]. After an error the
    /// environment must be reset.
    fn restore(&mut self, snapshot: &Snapshot) -> Result<()> {
        let mut state = snapshot.read(&self.spec().id)?;
        self.load_state(&mut state)?;
        state.finish()
    }
}

/// Boxed environments are environments, so that wrappers accept both.
impl<E: Environment + ?Sized> Environment for Box<E> {
    fn spec(&self) -> &EnvironmentSpec {
        (**self).spec()
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        (**self).reset(seed, options, observation)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        (**self).step(action, observation)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        (**self).save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        (**self).load_state(state)
    }

    fn render(&mut self) -> Result<Option<Image>> {
        (**self).render()
    }
}
