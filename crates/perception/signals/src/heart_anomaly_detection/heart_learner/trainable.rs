//! Networks of heart signals that train.

use burn::module::Module;
use burn::tensor::{Device, Tensor};
use opendr_engine::params::Params;
use opendr_training::TrainingParams;

use super::HeartKind;

/// Sizes common to all networks of heart signals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeartSizes {
    /// Time steps and features of a series.
    pub shape: [usize; 2],
    /// Number of classes.
    pub classes: usize,
    /// Dropout probability.
    pub dropout: f64,
}

/// A network kind that trains.
pub trait TrainableHeart: HeartKind + Sized {
    /// Training parameters of the learner.
    type FitParams: Params;
    /// Trained network.
    type Network: Module;

    /// Returns the parameters common to all trainings, and the weight of each class (empty for equal weights).
    fn training(fit_params: &Self::FitParams) -> (&TrainingParams, &[f32]);

    /// Returns a network with initial weights.
    fn network(params: &Self::Params, sizes: &HeartSizes, device: &Device) -> Self::Network;

    /// Returns logits `[batch, classes]` of series `[batch, time, features]`.
    fn forward(network: &Self::Network, series: Tensor<3>) -> Tensor<2>;
}
