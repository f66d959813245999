//! Settings that are known to solve an environment.

/// Settings of a learner and what they are made for.
#[derive(Debug, Clone, PartialEq)]
pub struct Preset<C> {
    /// How many environments are stepped together.
    pub environments: usize,
    /// Steps of a whole training.
    pub timesteps: u64,
    /// The settings of the learner.
    pub config: C,
}
