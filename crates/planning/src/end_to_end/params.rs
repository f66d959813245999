//! What a user may set of end-to-end planning.

use opendr_engine::params::Params;
use opendr_rl::{PpoConfig, Schedule};

/// Settings of [`EndToEndPlanning`](super::EndToEndPlanning), with OpenDR's names and defaults where OpenDR has them.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct EndToEndPlanningParams {
    /// Learning rate of Adam at the beginning; it falls evenly to zero.
    #[param(default = 3e-4, range = 0.0..=1.0, log)]
    pub lr: f32,
    /// Steps of all environments together between two updates.
    #[param(default = 1024, range = 1..=1_000_000, log)]
    pub n_steps: usize,
    /// Steps of a whole training; 300 000 give what is measured of the pretrained policy.
    #[param(default = 100_000, range = 1..=1_000_000_000, log)]
    pub iters: u64,
    /// Steps in a minibatch.
    #[param(default = 64, range = 1..=1_000_000, log)]
    pub batch_size: usize,
    /// A checkpoint is written after so many steps, rounded up to whole updates; 0 writes none.
    #[param(default = 500, range = 0..=1_000_000_000)]
    pub checkpoint_after_iter: u64,
    /// Threads that fly and learn; they change no bit of what is learnt.
    #[param(default = 2, range = 1..=256)]
    pub threads: usize,
    /// What fixes everything random.
    #[param(default = 0)]
    pub seed: u64,
}

impl EndToEndPlanningParams {
    /// The settings of PPO for so many environments.
    pub(super) fn ppo(&self, environments: usize) -> PpoConfig {
        let preset = PpoConfig::preset("UavDepthCorridor-v1");
        PpoConfig {
            learning_rate: self.lr,
            learning_rate_schedule: Schedule::Linear,
            n_steps: (self.n_steps / environments.max(1)).max(1),
            batch_size: self.batch_size,
            seed: self.seed,
            ..preset.map(|preset| preset.config).unwrap_or_default()
        }
    }
}
