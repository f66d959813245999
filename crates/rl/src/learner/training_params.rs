//! What a user may set of a training in environments, whatever the method.

use opendr_engine::params::Params;

/// How long a training goes, in how many environments, and how it is measured.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct RlTrainingParams {
    /// Steps of all environments together.
    #[param(default = 100_000, range = 1..=2_000_000_000, log, alias = "iters")]
    pub total_timesteps: u64,
    /// How many environments are stepped together.
    #[param(default = 1, range = 1..=65_536, log)]
    pub n_envs: usize,
    /// Threads that step environments and learn; they change no bit.
    #[param(default = 1, range = 1..=256)]
    pub num_workers: usize,
    /// Steps between two measurements of the policy; 0 measures it at the end only.
    #[param(default = 10_000, range = 0..=1_000_000_000)]
    pub eval_freq: u64,
    /// Episodes of a measurement.
    #[param(default = 20, range = 1..=1_000_000)]
    pub n_eval_episodes: u64,
    /// Steps between two checkpoints.
    #[param(default = 20_000, range = 1..=1_000_000_000)]
    pub checkpoint_after_iter: u64,
    /// How many checkpoints are kept.
    #[param(default = 2, range = 1..=1000)]
    pub checkpoints_kept: usize,
    /// Whether settings that are known to solve the environment stand in for those that have their default.
    #[param(default = true)]
    pub preset: bool,
}

/// `params`, with the values of `preset` where they have their default.
pub(super) fn over_preset<P: Params>(params: &P, preset: &P) -> P {
    let mut chosen = preset.clone();
    for (index, field) in P::FIELDS.iter().enumerate() {
        let own = params.get_at(index);
        if own != field.default.value() {
            chosen.set_at(index, &own);
        }
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PpoConfig, Schedule};

    #[test]
    fn a_preset_fills_defaults_only() {
        let preset = PpoConfig::preset("CartPole-v1").unwrap().config;
        let own = PpoConfig { gamma: 0.5, ..PpoConfig::default() };
        let chosen = over_preset(&own, &preset);
        assert_eq!((chosen.gamma, chosen.n_steps), (0.5, 32));
        assert_eq!(chosen.learning_rate_schedule, Schedule::Linear);
    }
}
