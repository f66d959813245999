//! Networks for keyword spotting that train.

use burn::module::Module;
use burn::tensor::{Device, Tensor};
use opendr_engine::params::Params;
use opendr_training::TrainingParams;

use super::WordKind;

/// Training parameters common to all keyword spotting learners.
#[derive(Debug, Clone, Params)]
pub struct WordFitParams {
    /// Dropout probability between layers.
    #[param(default = 0.2, range = 0.0..=0.99)]
    pub dropout: f64,
    /// Whether audio is shifted, changed in volume and mixed with noise, and its cepstra masked in part, at random.
    #[param(default = true)]
    pub augment: bool,
}

/// A network kind that trains.
pub trait TrainableWords: WordKind + Sized {
    /// Training parameters of the learner.
    type FitParams: Params;
    /// Trained network.
    type Network: Module;

    /// Returns the parameters common to all trainings, and those common to the keyword spotting learners.
    fn training(fit_params: &Self::FitParams) -> (&TrainingParams, &WordFitParams);

    /// Returns a network for `classes` with initial weights and the given dropout probability.
    fn network(params: &Self::Params, classes: usize, dropout: f64, device: &Device) -> Self::Network;

    /// Returns logits `[batch, classes]` of cepstra `[batch, coefficients, frames]`.
    fn forward(network: &Self::Network, cepstra: Tensor<3>) -> Tensor<2>;
}
