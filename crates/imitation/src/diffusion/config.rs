//! Settings of diffusion policy.

use opendr_engine::params::Params;

/// Settings of the network of a diffusion policy. Names as in LeRobot.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct DiffusionConfig {
    /// Observations that the prediction depends on, the current one last.
    #[param(default = 2, range = 1..=64)]
    pub n_obs_steps: usize,
    /// Actions per prediction, from that of the oldest observation on.
    #[param(default = 16, range = 1..=1000)]
    pub horizon: usize,
    /// Noise levels in training.
    #[param(default = 100, range = 2..=10_000)]
    pub num_train_timesteps: usize,
    /// Numbers of the embedding of the noise level; even.
    #[param(default = 64, range = 2..=1024)]
    pub diffusion_step_embed_dim: usize,
    /// Numbers of the condition that observations and noise level are encoded to.
    #[param(default = 256, range = 1..=4096)]
    pub cond_dim: usize,
    /// Width of the blocks of the denoiser.
    #[param(default = 512, range = 1..=8192)]
    pub width: usize,
    /// Blocks of the denoiser.
    #[param(default = 3, range = 1..=32)]
    pub n_blocks: usize,
}

/// Parameters of a diffusion policy at inference.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct DiffusionParams {
    /// Denoising steps per prediction (DDIM).
    #[param(default = 10, range = 1..=1000)]
    pub num_inference_steps: usize,
    /// Actions of a prediction that are executed before the next one.
    #[param(default = 8, range = 1..=1000)]
    pub n_action_steps: usize,
    /// Seed of the noise, at the start of a stream.
    #[param(default = 0)]
    pub seed: u64,
}
