//! Settings of residual policies.

use opendr_engine::environment::{Controller, Snapshot, Space, StateReader};
use opendr_engine::params::Params;
use opendr_engine::{Error, Result};

use super::residual::{Correction, residual_spaces};
use super::{AlphaSchedule, Prior, SafetyRule, Shield};
use crate::{PpoConfig, SacConfig, Td3Config};

/// Settings of a policy that corrects a prior, whatever trains it.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct ResidualConfig {
    /// Name of the prior, in its newest version (`opendr sim priors` lists them).
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
    /// Returns the prior.
    ///
    /// # Errors
    /// As [`Prior::newest`].
    pub fn prior(&self) -> Result<Prior> {
        Prior::newest(&self.prior)
    }

    /// Returns the factor of corrections in a training with so many environments.
    ///
    /// # Errors
    /// As [`AlphaSchedule::linear`].
    pub fn schedule(&self, environments: usize) -> Result<AlphaSchedule> {
        AlphaSchedule::linear(self.alpha_start, self.alpha, self.alpha_steps / environments.max(1) as u64)
    }

    /// Returns a shield of the corrections in a [`Residual`](super::Residual) environment with observations of `space`: where `rule` calls
    /// the executed action unsafe, the correction is zero and the prior acts.
    ///
    /// # Errors
    /// `InvalidParam` where the factor changes during the training, since the executed action is then unknown here; as
    /// [`SafetyRule::predicate`].
    pub fn shield(&self, rule: &SafetyRule, space: &Space) -> Result<Shield> {
        if self.alpha_start != self.alpha && self.alpha_steps > 0 {
            return Err(Error::invalid_param(format!(
                "a shield with alpha from {} to {}; set alpha_start to alpha",
                self.alpha_start, self.alpha
            )));
        }
        let (own, actions) = residual_spaces(space)?;
        let (mut predicate, correction, alpha) =
            (rule.predicate(own)?, Correction::new(actions)?, self.alpha);
        let (seen, mut executed) = (own.len(), vec![0.0; actions.len()]);
        let is_unsafe = move |observation: &[f32], action: &[f32]| {
            let (observation, proposal) = observation.split_at(seen);
            correction.add(proposal, action, alpha, &mut executed);
            predicate(observation, &executed)
        };
        Ok(Shield::new(is_unsafe, Box::new(NoCorrection)))
    }

    /// Returns `config` changed to train corrections: the actor waits for the critic.
    pub fn ppo(&self, config: &PpoConfig) -> PpoConfig {
        PpoConfig {
            actor_starts: self.critic_warmup,
            log_std_init: self.correction_log_std,
            ..config.clone()
        }
    }

    /// Returns `config` changed to train corrections: SAC explores from the prior, with a small weight of the entropy at first,
    /// which would make the corrections wide otherwise.
    pub fn sac(&self, config: &SacConfig) -> SacConfig {
        let mut config = config.clone();
        config.off_policy.starts_with_policy = true;
        config.off_policy.actor_starts = self.critic_warmup;
        config.ent_coef_init = config.ent_coef_init.min(SMALL_ENTROPY);
        config
    }

    /// Returns `config` changed to train corrections: the noise of TD3 explores around the prior.
    pub fn td3(&self, config: &Td3Config) -> Td3Config {
        let mut config = config.clone();
        config.off_policy.starts_with_policy = true;
        config.off_policy.actor_starts = self.critic_warmup;
        config
    }
}

/// The largest first weight of SAC's entropy.
const SMALL_ENTROPY: f32 = 0.01;

/// Corrects nothing, so that the prior acts.
struct NoCorrection;

impl Controller for NoCorrection {
    fn act(&mut self, _: &[f32], correction: &mut [f32]) -> Result<()> {
        correction.fill(0.0);
        Ok(())
    }

    fn save_state(&self, _: &mut Snapshot) -> Result<()> {
        Ok(())
    }

    fn load_state(&mut self, _: &mut StateReader<'_>) -> Result<()> {
        Ok(())
    }
}
