//! The parts of a diffusion policy.

use super::config::DiffusionConfig;
use super::denoiser::Denoiser;
use super::schedule::NoiseSchedule;

/// Diffusion policy: predicts a chunk of actions by removing noise from a random one, step by step, so that it can follow one of
/// several ways that demonstrations took instead of their mean.
///
/// Horizons, noise schedule, scaling and optimisation are the paper's; the network is one of residual blocks on the whole chunk, as in
/// the study of Ren et al. (2024) for observations of numbers, which a CPU trains in minutes, instead of a U-Net.
#[derive(Debug, Clone)]
pub struct DiffusionPolicy {
    pub(super) config: DiffusionConfig,
    pub(super) schedule: NoiseSchedule,
    pub(super) denoiser: Denoiser,
}
