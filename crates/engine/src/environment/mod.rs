//! Worlds that policies act in, with the meaning of Gymnasium 1.x.

mod controller;
mod environment_source;
mod info;
mod snapshot;
mod space;
mod spec;

use crate::data::Image;
use crate::{Error, Result};

pub use controller::Controller;
pub use environment_source::EnvironmentSource;
pub use info::Info;
pub use snapshot::{Snapshot, StateReader};
pub use space::{Dtype, Space};
pub use spec::EnvironmentSpec;

/// What a reset is asked for beside its seed, e.g. `low` and `high` of the initial state.
pub type ResetOptions = crate::params::ParamMap;

/// What a step earned and whether the episode is over. The observation lies where the caller wanted it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Step {
    /// The reward.
    pub reward: f64,
    /// The task itself ended (goal, crash): no value lies behind this state.
    pub terminated: bool,
    /// The episode was cut from outside (time limit): the state still has a value.
    pub truncated: bool,
    /// What else is known of the step.
    pub info: Info,
}

impl Step {
    /// Whether the next call must be a reset.
    pub fn is_over(&self) -> bool {
        self.terminated || self.truncated
    }
}

/// A world: `reset`, then `step` until it is terminated or truncated.
///
/// Observations and actions are numbers in a row, as their [`Space`] lays them out, in memory of the caller: a step
/// allocates nothing.
pub trait Environment: Send {
    /// Name, spaces, limits.
    fn spec(&self) -> &EnvironmentSpec;

    /// Begins an episode and writes its first observation. A seed fixes everything random until the next one; without
    /// a seed the stream of random numbers goes on (and begins by chance in a new environment).
    ///
    /// # Errors
    /// `InvalidInput` when `observation` has not the space's length, `InvalidParam` for options that do not fit.
    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info>;

    /// Takes one step and writes the next observation.
    ///
    /// # Errors
    /// `InvalidInput` when the action lies outside its space, before the first reset, and after the end of an episode.
    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step>;

    /// Writes everything that decides the future, random numbers included.
    ///
    /// # Errors
    /// `Unsupported` where a world cannot be written.
    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        let _ = snapshot;
        Err(Error::unsupported(format!("{} keeps no snapshots", self.spec().id)))
    }

    /// Takes back what [`Self::save_state`] wrote, in the same order.
    ///
    /// # Errors
    /// `Unsupported` where a world cannot be written, `Format` when the snapshot is of something else.
    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let _ = state;
        Err(Error::unsupported(format!("{} keeps no snapshots", self.spec().id)))
    }

    /// A picture of the world as it is, where it can draw itself.
    ///
    /// # Errors
    /// `InvalidInput` before the first reset.
    fn render(&mut self) -> Result<Option<Image>> {
        Ok(None)
    }

    /// The state of now, to come back to: for planning, exact replay, checkpoints.
    ///
    /// # Errors
    /// As [`Self::save_state`].
    fn snapshot(&self) -> Result<Snapshot> {
        let mut snapshot = Snapshot::new(&self.spec().id);
        self.save_state(&mut snapshot)?;
        Ok(snapshot)
    }

    /// Goes back to a state: the same actions then have the same outcome, bit for bit.
    ///
    /// # Errors
    /// `InvalidInput` for a snapshot of another environment, else as [`Self::load_state`]. After an error the
    /// environment must be reset.
    fn restore(&mut self, snapshot: &Snapshot) -> Result<()> {
        let mut state = snapshot.read(&self.spec().id)?;
        self.load_state(&mut state)?;
        state.finish()
    }
}

/// A boxed environment is one too, so that wrappers take both.
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
