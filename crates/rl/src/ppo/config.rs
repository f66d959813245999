//! Settings of PPO.

use opendr_engine::params::Params;
use opendr_engine::{Error, Result};

use crate::policy::NetworkConfig;
use crate::preset::Preset;
use crate::schedule::Schedule;

/// Settings of [`Ppo`](super::Ppo). Names and defaults are those of Stable-Baselines3. Schedules and the wrapper `VecNormalize`,
/// which are objects there, are parameters here.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct PpoConfig {
    /// Learning rate of Adam.
    #[param(default = 3e-4, range = 0.0..=1.0, log)]
    pub learning_rate: f32,
    /// Schedule of the learning rate.
    pub learning_rate_schedule: Schedule,
    /// Steps of each environment between two updates.
    #[param(default = 2048, range = 1..=1_000_000, log)]
    pub n_steps: usize,
    /// Steps per minibatch.
    #[param(default = 64, range = 1..=1_000_000, log)]
    pub batch_size: usize,
    /// Passes over the collected steps per update.
    #[param(default = 10, range = 1..=1000)]
    pub n_epochs: usize,
    /// Discount factor.
    #[param(default = 0.99, range = 0.0..=1.0)]
    pub gamma: f32,
    /// Lambda of generalised advantage estimation: 0 for one-step, 1 for Monte Carlo estimates.
    #[param(default = 0.95, range = 0.0..=1.0)]
    pub gae_lambda: f32,
    /// Clipping range of the probability ratio.
    #[param(default = 0.2, range = 0.0..=10.0)]
    pub clip_range: f32,
    /// Schedule of the clipping range.
    pub clip_range_schedule: Schedule,
    /// Clipping range of the values; none means no clipping. It depends on the scale of the rewards.
    #[param(range = 0.0..=1e9)]
    pub clip_range_vf: Option<f32>,
    /// Whether the advantages of a minibatch are normalised to mean 0 and standard deviation 1.
    #[param(default = true)]
    pub normalize_advantage: bool,
    /// Weight of the entropy in the loss.
    #[param(default = 0.0, range = 0.0..=10.0)]
    pub ent_coef: f32,
    /// Weight of the value loss.
    #[param(default = 0.5, range = 0.0..=100.0)]
    pub vf_coef: f32,
    /// Maximum norm of the gradients.
    #[param(default = 0.5, range = 0.0..=1e9)]
    pub max_grad_norm: f32,
    /// KL divergence at 1.5 times which an update is stopped; none means no limit.
    #[param(range = 0.0..=1e9)]
    pub target_kl: Option<f32>,
    /// Networks of the policy.
    #[param(flatten)]
    pub network: NetworkConfig,
    /// Steps per training sequence of a recurrent policy; a sequence lies in one minibatch. None means as many as fit into a
    /// minibatch. Other policies train on single steps.
    #[param(range = 1..=1_000_000)]
    pub sequence_length: Option<usize>,
    /// Units of the hidden layers of the value network; none means those of the policy.
    #[param(range = 1..=4096)]
    pub net_arch_vf: Option<Vec<usize>>,
    /// Whether weights are initialised orthogonally, else by PyTorch's default.
    #[param(default = true)]
    pub ortho_init: bool,
    /// Steps of all environments before the actor is trained; only the critic is trained until then.
    #[param(default = 0, range = 0..=1_000_000_000)]
    pub actor_starts: u64,
    /// Initial log standard deviation of continuous actions.
    #[param(default = 0.0, range = -20.0..=20.0)]
    pub log_std_init: f32,
    /// Whether observations are normalised by the running mean and variance of the training.
    #[param(default = false)]
    pub norm_obs: bool,
    /// Whether rewards are divided by the standard deviation of the discounted return.
    #[param(default = false)]
    pub norm_reward: bool,
    /// Normalised observations are clipped to plus and minus this value.
    #[param(default = 10.0, range = 0.0..=1e9)]
    pub clip_obs: f32,
    /// Normalised rewards are clipped to plus and minus this value.
    #[param(default = 10.0, range = 0.0..=1e9)]
    pub clip_reward: f32,
    /// Seed of all random numbers.
    #[param(default = 0)]
    pub seed: u64,
}

impl PpoConfig {
    /// Returns the steps per training sequence: a divisor of `n_steps`, 1 without a recurrent unit.
    pub(super) fn steps_of_sequence(&self) -> Result<usize> {
        let longest = match (self.network.gru_size, self.sequence_length) {
            (None, _) => 1,
            (Some(_), None) => self.batch_size.min(self.n_steps),
            (Some(_), Some(length)) if self.n_steps.is_multiple_of(length) => length,
            (Some(_), Some(length)) => {
                return Err(Error::invalid_param(format!(
                    "sequence_length = {length} does not divide n_steps = {}; make n_steps a multiple of it",
                    self.n_steps
                )));
            }
        };
        let divides = |length: &usize| self.n_steps.is_multiple_of(*length);
        Ok((1..=longest).rev().find(divides).unwrap_or(1))
    }

    /// Returns the settings of rl-zoo for an environment, if PPO alone can use them (twice as many steps for `Pendulum-v1`), or those
    /// tuned here for `UavDepthCorridor-compact-v1`, and for `UavDepthCorridor-v1` wrapped in
    /// [`FlightMemoryWrapper`](opendr_simulation::uav_corridor::FlightMemoryWrapper).
    pub fn preset(id: &str) -> Option<Preset<Self>> {
        let base = Self::default();
        let (environments, timesteps, config) = match id {
            "CartPole-v1" => (
                8,
                100_000,
                Self {
                    n_steps: 32,
                    batch_size: 256,
                    gae_lambda: 0.8,
                    gamma: 0.98,
                    n_epochs: 20,
                    learning_rate: 1e-3,
                    learning_rate_schedule: Schedule::Linear,
                    clip_range_schedule: Schedule::Linear,
                    ..base
                },
            ),
            "Pendulum-v1" => (4, 200_000, Self { n_steps: 1024, gamma: 0.9, learning_rate: 1e-3, ..base }),
            "Acrobot-v1" => (
                16,
                1_000_000,
                Self {
                    n_steps: 256,
                    gae_lambda: 0.94,
                    n_epochs: 4,
                    norm_obs: true,
                    norm_reward: true,
                    ..base
                },
            ),
            "MountainCar-v0" => (
                16,
                1_000_000,
                Self {
                    n_steps: 16,
                    gae_lambda: 0.98,
                    n_epochs: 4,
                    norm_obs: true,
                    norm_reward: true,
                    ..base
                },
            ),
            "UavDepthCorridor-v1" | "UavDepthCorridor-compact-v1" => (
                8,
                300_000,
                Self {
                    n_steps: 128,
                    learning_rate_schedule: Schedule::Linear,
                    log_std_init: -1.0,
                    norm_reward: true,
                    ..base
                },
            ),
            _ => return None,
        };
        Some(Preset { environments, timesteps, config })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_set_by_name() {
        let mut config = PpoConfig::default();
        for (name, text) in
            [("net_arch", "32,16"), ("target_kl", "0.02"), ("net_arch_vf", "8"), ("activation_fn", "relu")]
        {
            config.set_text(name, text).unwrap();
        }
        assert_eq!((&config.network.net_arch[..], config.target_kl), (&[32, 16][..], Some(0.02)));
        assert_eq!(config.net_arch_vf, Some(vec![8]));
        assert!(config.set_text("gamma", "1.5").is_err());
        assert_eq!(PpoConfig::from_map(&config.to_map()).unwrap(), config);
        assert!(PpoConfig::preset("Nothing-v0").is_none());
        PpoConfig::preset("CartPole-v1").unwrap().config.check().unwrap();
    }

    #[test]
    fn sequences_divide_the_steps() {
        let mut config = PpoConfig { n_steps: 48, batch_size: 20, ..PpoConfig::default() };
        assert_eq!(config.steps_of_sequence().unwrap(), 1);
        config.network.gru_size = Some(8);
        assert_eq!(config.steps_of_sequence().unwrap(), 16);
        config.sequence_length = Some(12);
        assert_eq!(config.steps_of_sequence().unwrap(), 12);
        config.sequence_length = Some(10);
        assert!(config.steps_of_sequence().unwrap_err().to_string().contains("n_steps = 48"));
    }
}
