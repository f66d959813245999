//! The motion with the highest expected gain.

use opendr_engine::{Error, Result};
use opendr_kernels::Compute;

use super::{CameraContext, CameraPolicy};
use crate::gain::GainNetwork;

/// Chooses, of all motions with each axis at -1, 0 or 1, the one with the highest expected gain.
pub struct GreedyPolicy {
    gain: GainNetwork,
    candidates: Vec<f32>,
    compute: Compute,
}

impl GreedyPolicy {
    /// Creates the policy from a network of expected gains.
    pub fn new(gain: GainNetwork) -> Self {
        let axes = gain.axes();
        let choices = 3usize.pow(axes as u32);
        let digit = |choice: usize, axis: usize| choice / 3usize.pow(axis as u32) % 3;
        let candidates =
            (0..choices).flat_map(|choice| (0..axes).map(move |axis| digit(choice, axis) as f32 - 1.0));
        Self { candidates: candidates.collect(), gain, compute: Compute::single() }
    }
}

impl CameraPolicy for GreedyPolicy {
    fn choose(&mut self, context: &CameraContext<'_>, action: &mut [f32]) -> Result<()> {
        let axes = self.gain.axes();
        if action.len() != axes {
            return Err(Error::invalid_input(format!(
                "gains of motions of {axes} axes for a rig of {}; train them on this rig",
                action.len()
            )));
        }
        let gains = self.gain.predict(&self.compute, context.observation, &self.candidates)?;
        let best = gains.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(at, _)| at);
        action.copy_from_slice(&self.candidates[best * axes..(best + 1) * axes]);
        Ok(())
    }
}
