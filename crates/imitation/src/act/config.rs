//! Settings of ACT.

use opendr_engine::params::Params;

use crate::transformer::TransformerSizes;

/// Settings of the network of ACT. Names as in LeRobot; the network is smaller, since observations are states, not images.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct ActConfig {
    /// Actions per prediction.
    #[param(default = 20, range = 1..=1000)]
    pub chunk_size: usize,
    /// Numbers per token.
    #[param(default = 128, range = 4..=2048)]
    pub dim_model: usize,
    /// Heads of the attention; they divide `dim_model`.
    #[param(default = 4, range = 1..=64)]
    pub n_heads: usize,
    /// Units of the layers between attentions.
    #[param(default = 256, range = 1..=8192)]
    pub dim_feedforward: usize,
    /// Blocks of the encoder of observation and latent variable.
    #[param(default = 2, range = 1..=24)]
    pub n_encoder_layers: usize,
    /// Blocks of the decoder of actions.
    #[param(default = 2, range = 1..=24)]
    pub n_decoder_layers: usize,
    /// Whether a variational encoder of the demonstrated actions gives the latent variable in training.
    #[param(default = true)]
    pub use_vae: bool,
    /// Numbers of the latent variable.
    #[param(default = 16, range = 1..=1024)]
    pub latent_dim: usize,
    /// Blocks of the variational encoder.
    #[param(default = 2, range = 1..=24)]
    pub n_vae_encoder_layers: usize,
    /// Weight of the Kullback-Leibler divergence in the loss.
    #[param(default = 10.0, range = 0.0..=1000.0)]
    pub kl_weight: f32,
}

impl ActConfig {
    /// Returns the sizes of a transformer of this number of layers.
    pub(super) fn sizes(&self, layers: usize) -> TransformerSizes {
        TransformerSizes { size: self.dim_model, heads: self.n_heads, hidden: self.dim_feedforward, layers }
    }
}

/// Parameters of ACT at inference.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct ActParams {
    /// Whether each action is the weighted mean of all predictions for its step, with one prediction per step.
    #[param(default = true)]
    pub temporal_ensemble: bool,
    /// Decay of the weights of newer predictions: `exp(-coefficient i)`, where i is 0 for the oldest.
    #[param(default = 0.01, range = -10.0..=10.0)]
    pub temporal_ensemble_coeff: f32,
    /// Actions of a chunk that are executed before the next prediction, without temporal ensemble.
    #[param(default = 10, range = 1..=1000)]
    pub n_action_steps: usize,
}
