//! Hyperparameters known to solve an environment.

/// Settings of an algorithm for one environment.
#[derive(Debug, Clone, PartialEq)]
pub struct Preset<C> {
    /// Number of parallel environments.
    pub environments: usize,
    /// Steps of a whole training, over all environments.
    pub timesteps: u64,
    /// Settings of the algorithm.
    pub config: C,
}
