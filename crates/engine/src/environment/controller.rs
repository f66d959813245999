//! Controllers: policies that are not trained.

use super::{Snapshot, StateReader};
use crate::{Error, Result};

/// Computes an action from an observation: a feedback law, a planner, a person. Closures implement it.
pub trait Controller {
    /// Resets the state; called at the start of an episode.
    fn reset(&mut self) {}

    /// Writes the action for an observation into `action`.
    ///
    /// # Errors
    /// Returns `InvalidInput` for an observation of another space.
    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()>;

    /// Notes the action that was executed instead of the one that the last [`act`](Self::act) wrote: a policy corrected it, or a
    /// shield replaced it. Controllers that integrate their own actions need it.
    fn executed(&mut self, action: &[f32]) {
        let _ = action;
    }

    /// Writes the state that the next actions depend on.
    ///
    /// # Errors
    /// `Unsupported` for a controller that may have a state and cannot write it, such as a closure.
    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        let _ = snapshot;
        Err(Error::unsupported("this controller writes no state; implement Controller::save_state for it"))
    }

    /// Reads the state that [`save_state`](Self::save_state) wrote.
    ///
    /// # Errors
    /// `Unsupported` as there, `Format` for the state of something else.
    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let _ = state;
        Err(Error::unsupported("this controller reads no state; implement Controller::load_state for it"))
    }
}

impl<F: FnMut(&[f32], &mut [f32]) -> Result<()>> Controller for F {
    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        self(observation, action)
    }
}
