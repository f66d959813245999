//! Worlds that policies act in, with the meaning of Gymnasium 1.x.

use crate::Result;

/// What observations or actions look like.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Space {
    /// Real numbers within bounds, any shape.
    Box {
        /// Smallest value of each element.
        low: Vec<f32>,
        /// Largest value of each element.
        high: Vec<f32>,
        /// Size of each axis.
        shape: Vec<usize>,
    },
    /// One of `n` numbers beginning with `start`.
    Discrete {
        /// How many.
        n: u32,
        /// The first.
        start: i64,
    },
    /// Several discrete choices at once.
    MultiDiscrete(Vec<u32>),
}

impl Space {
    /// How many numbers one element of the space has when it is written flat.
    pub fn len(&self) -> usize {
        match self {
            Self::Box { low, .. } => low.len(),
            Self::Discrete { .. } => 1,
            Self::MultiDiscrete(counts) => counts.len(),
        }
    }

    /// Whether an element has no number.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// What a step earned and whether the episode is over.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Step {
    /// The reward.
    pub reward: f32,
    /// The task itself ended (goal, crash): no value lies behind this state.
    pub terminated: bool,
    /// The episode was cut from outside (time limit): the state still has a value.
    pub truncated: bool,
}

/// A world: `reset`, then `step` until it is terminated or truncated.
pub trait Environment: Send {
    /// What an observation looks like.
    fn observation_space(&self) -> &Space;

    /// What an action looks like.
    fn action_space(&self) -> &Space;

    /// Begins an episode and writes its first observation; a seed fixes the whole episode.
    ///
    /// # Errors
    /// `InvalidInput` when `observation` has not the space's length.
    fn reset(&mut self, seed: Option<u64>, observation: &mut [f32]) -> Result<()>;

    /// Takes one step and writes the next observation.
    ///
    /// # Errors
    /// `InvalidInput` when the action lies outside the space or the episode is over.
    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step>;
}
