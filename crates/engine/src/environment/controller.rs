//! Controllers: policies that are not trained.

use crate::Result;

/// Computes an action from an observation: a feedback law, a planner, a person. Closures implement it.
pub trait Controller {
    /// Resets the state; called at the start of an episode.
    fn reset(&mut self) {}

    /// Writes the action for an observation into `action`.
    ///
    /// # Errors
    /// Returns `InvalidInput` for an observation of another space.
    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()>;
}

impl<F: FnMut(&[f32], &mut [f32]) -> Result<()>> Controller for F {
    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        self(observation, action)
    }
}
