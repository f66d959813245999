//! Parameters of learners of active perception.

use opendr_engine::params::Params;

use crate::stop::StopRule;
use crate::training::ActiveTraining;
use crate::view_classifier::{ViewClassifierConfig, ViewTraining};

/// Parameters at inference.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct ActiveParams {
    /// Maximum number of motions for a subject.
    #[param(default = 6, range = 0..=100, live)]
    pub moves: u32,
    /// Probability of the most likely class at which no further motion is proposed.
    #[param(default = 0.97, range = 0.0..=1.0, live)]
    pub confidence: f32,
    /// Expected rise of the probability of the true class below which no further motion is proposed; 0 disables the rule.
    #[param(default = 0.0, range = 0.0..=1.0, live)]
    pub min_gain: f32,
}

/// Parameters of the training.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct ActiveFitParams {
    /// Number of motions in all environments together for training the camera policy; 0 keeps that of the base model and
    /// only calibrates the belief.
    #[param(default = 400_000, range = 0..=1_000_000_000, alias = "iters")]
    pub total_timesteps: u64,
    /// Number of episodes in each pair of epochs whose views train the estimator of the best view and, if no data set is given, the recogniser; 0
    /// keeps those of the base model.
    #[param(default = 12_000, range = 0..=10_000_000)]
    pub view_episodes: u64,
    /// Number of epochs of recogniser and estimator.
    #[param(default = 10, range = 1..=1000)]
    pub epochs: u32,
    /// Kernels of the first convolution of the recogniser; the second has twice, the third three times as many.
    #[param(default = 24, range = 1..=512)]
    pub kernels: u32,
    /// Neurons of its hidden layer.
    #[param(default = 128, range = 1..=4096)]
    pub hidden: u32,
    /// Number of environments.
    #[param(default = 16, range = 1..=1024)]
    pub n_envs: u32,
    /// Number of threads.
    #[param(default = 2, range = 1..=256)]
    pub num_workers: u32,
    /// Number of episodes for each calibration of the belief.
    #[param(default = 1000, range = 50..=1_000_000)]
    pub calibration_episodes: u64,
    /// Seed of all random numbers.
    #[param(default = 0, range = 0..=1_000_000)]
    pub seed: u64,
}

impl ActiveParams {
    /// Returns the stop rule.
    pub(super) fn stop(&self) -> StopRule {
        StopRule { moves: self.moves as usize, confidence: self.confidence, gain: self.min_gain }
    }
}

impl ActiveFitParams {
    /// Returns the settings of the recogniser's training.
    pub fn view_training(&self) -> ViewTraining {
        let kernels = self.kernels as usize;
        let config = ViewClassifierConfig {
            side: 0,
            kernels: vec![kernels, 2 * kernels, 3 * kernels],
            hidden: self.hidden as usize,
            dimension: 24,
            classes: 0,
        };
        ViewTraining { config, epochs: self.epochs as usize, seed: self.seed }
    }

    /// Returns the settings of the camera policy's training.
    pub fn active_training(&self, params: &ActiveParams) -> ActiveTraining {
        ActiveTraining {
            timesteps: self.total_timesteps,
            environments: self.n_envs as usize,
            threads: self.num_workers as usize,
            calibration_episodes: self.calibration_episodes,
            stop: params.stop(),
            seed: self.seed,
        }
    }
}
