//! Off-policy methods: the settings, the replay buffer and the training loop that DQN, TD3 and SAC share.

mod algorithm;
mod experience;

use opendr_engine::params::Params;

pub(crate) use algorithm::{OffPolicyAlgorithm, OffPolicyBase};
pub(crate) use experience::Experience;

/// Settings shared by SAC, TD3 and DQN. Names are those of Stable-Baselines3, and so are the defaults of each method.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct OffPolicyConfig {
    /// Learning rate of Adam, for all networks.
    #[param(default = 3e-4, range = 0.0..=1.0, log)]
    pub learning_rate: f32,
    /// Capacity of the replay buffer, in steps.
    #[param(default = 1_000_000, range = 1..=1_000_000_000, log)]
    pub buffer_size: usize,
    /// Steps of all environments with random actions before training begins.
    #[param(default = 100, range = 0..=1_000_000_000)]
    pub learning_starts: u64,
    /// Whether the actions before training begins are those of the policy instead of random ones, for a policy that starts from prior
    /// knowledge.
    #[param(default = false)]
    pub starts_with_policy: bool,
    /// Steps of all environments before the actor is trained; only the critic is trained until then. DQN has no actor.
    #[param(default = 0, range = 0..=1_000_000_000)]
    pub actor_starts: u64,
    /// Transitions per gradient step.
    #[param(default = 256, range = 1..=1_000_000, log)]
    pub batch_size: usize,
    /// Soft update coefficient of the target networks; 1 copies the parameters.
    #[param(default = 0.005, range = 0.0..=1.0, log)]
    pub tau: f32,
    /// Discount factor.
    #[param(default = 0.99, range = 0.0..=1.0)]
    pub gamma: f32,
    /// Steps of each environment between two updates.
    #[param(default = 1, range = 1..=1_000_000)]
    pub train_freq: usize,
    /// Gradient steps per update; none means one per collected step.
    #[param(default = Some(1), range = 1..=1_000_000)]
    pub gradient_steps: Option<usize>,
    /// Whether observations are normalised by the running mean and variance of the training.
    #[param(default = false)]
    pub norm_obs: bool,
    /// Normalised observations are clipped to plus and minus this value.
    #[param(default = 10.0, range = 0.0..=1e9)]
    pub clip_obs: f32,
    /// Seed of all random numbers.
    #[param(default = 0)]
    pub seed: u64,
}

impl OffPolicyConfig {
    /// Returns the clipping bound of normalised observations; none if they are not normalised.
    pub(crate) fn clip(&self) -> Option<f32> {
        self.norm_obs.then_some(self.clip_obs)
    }

    /// Whether the actions of this step are random ones.
    pub(crate) fn takes_random_actions(&self, timesteps: u64) -> bool {
        !self.starts_with_policy && timesteps < self.learning_starts
    }

    /// Whether the actor is trained after this step.
    pub(crate) fn trains_actor(&self, timesteps: u64) -> bool {
        timesteps > self.actor_starts
    }
}
