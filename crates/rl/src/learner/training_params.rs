//! Parameters of any training in environments.

use opendr_engine::params::Params;

/// Length of a training, number of environments, evaluations and checkpoints.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct RlTrainingParams {
    /// Steps of a whole training, over all environments.
    #[param(default = 100_000, range = 1..=2_000_000_000, log, alias = "iters")]
    pub total_timesteps: u64,
    /// Number of parallel environments.
    #[param(default = 1, range = 1..=65_536, log)]
    pub n_envs: usize,
    /// Threads for environments and learning; results do not depend on them.
    #[param(default = 1, range = 1..=256)]
    pub num_workers: usize,
    /// Steps between two evaluations of the policy; 0 evaluates at the end only.
    #[param(default = 10_000, range = 0..=1_000_000_000)]
    pub eval_freq: u64,
    /// Episodes per evaluation.
    #[param(default = 20, range = 1..=1_000_000)]
    pub n_eval_episodes: u64,
    /// Steps between two checkpoints.
    #[param(default = 20_000, range = 1..=1_000_000_000)]
    pub checkpoint_after_iter: u64,
    /// Number of checkpoints that are kept.
    #[param(default = 2, range = 1..=1000)]
    pub checkpoints_kept: usize,
    /// Whether parameters left at their defaults take the values of the environment's preset, if there is one.
    #[param(default = true)]
    pub preset: bool,
}

/// Returns `params`, with the values of `preset` for those at their defaults.
pub(crate) fn over_preset<P: Params>(params: &P, preset: &P) -> P {
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
