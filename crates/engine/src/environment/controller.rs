//! What acts without having learnt.

use crate::Result;

/// Gives an action for an observation: a feedback law, a planner, a person. A closure of observation and action is one.
pub trait Controller {
    /// Forgets the episode; called when another begins.
    fn reset(&mut self) {}

    /// Writes the action for an observation.
    ///
    /// # Errors
    /// `InvalidInput` for an observation of another space.
    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()>;
}

impl<F: FnMut(&[f32], &mut [f32]) -> Result<()>> Controller for F {
    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        self(observation, action)
    }
}
