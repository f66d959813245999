//! Settings of residual policies.

use opendr_engine::Result;
use opendr_engine::params::Params;

use super::{AlphaSchedule, Prior};
use crate::{PpoConfig, SacConfig, Td3Config};

/// Settings of a policy that corrects a prior, whatever trains it.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct ResidualConfig {
    /// Name of the prior, in its newest version.
    #[param(default = "corridor-reactive".to_owned())]
    pub prior: String,
    /// Factor of the corrections. At 1 a correction reaches from the middle of the bounds of an action to a bound, at 2 from one bound
    /// to the other.
    #[param(default = 2.0, range = 0.0..=2.0)]
    pub alpha: f32,
    /// Factor at the beginning of the training.
    #[param(default = 2.0, range = 0.0..=2.0)]
    pub alpha_start: f32,
    /// Steps of all environments over which the factor changes evenly from the first to the last.
    #[param(default = 0, range = 0..=2_000_000_000)]
    pub alpha_steps: u64,
    /// Steps of all environments before the actor moves; only the values learn until then.
    #[param(default = 8192, range = 0..=1_000_000_000)]
    pub critic_warmup: u64,
    /// Logarithm of the first deviation of corrections.
    #[param(default = -1.0, range = -20.0..=2.0)]
    pub correction_log_std: f32,
}

impl ResidualConfig {
    /// The prior.
    ///
    /// # Errors
    /// As [`Prior::newest`].
    pub fn prior(&self) -> Result<Prior> {
        Prior::newest(&self.prior)
    }

    /// The factor of corrections in a training with so many environments.
    ///
    /// # Errors
    /// As [`AlphaSchedule::linear`].
    pub fn schedule(&self, environments: usize) -> Result<AlphaSchedule> {
        AlphaSchedule::linear(self.alpha_start, self.alpha, self.alpha_steps / environments.max(1) as u64)
    }

    /// `config` as it trains corrections: the actor waits for the values.
    pub fn ppo(&self, config: &PpoConfig) -> PpoConfig {
        PpoConfig {
            actor_starts: self.critic_warmup,
            log_std_init: self.correction_log_std,
            ..config.clone()
        }
    }

    /// The same for SAC: it explores from the prior, with a small weight of the entropy at first, which would make the corrections
    /// wide otherwise.
    pub fn sac(&self, config: &SacConfig) -> SacConfig {
        let mut config = config.clone();
        config.off_policy.starts_with_policy = true;
        config.off_policy.actor_starts = self.critic_warmup;
        config.ent_coef_init = config.ent_coef_init.min(SMALL_ENTROPY);
        config
    }

    /// The same for TD3, whose noise explores around the prior.
    pub fn td3(&self, config: &Td3Config) -> Td3Config {
        let mut config = config.clone();
        config.off_policy.starts_with_policy = true;
        config.off_policy.actor_starts = self.critic_warmup;
        config
    }
}

/// The largest first weight of SAC's entropy.
const SMALL_ENTROPY: f32 = 0.01;
