//! Training of the Self-ONN.

use burn::tensor::{Device, Tensor};
use opendr_engine::params::Params;
use opendr_training::{OptimizerKind, TrainingParams};

use super::network::QuadraticSelfOnnNetwork;
use super::{QuadraticSelfOnnKind, QuadraticSelfOnnParams};
use crate::speech_recognition::word_learner::{TrainableWords, WordFitParams};

/// Training parameters of [`QuadraticSelfOnn`](super::QuadraticSelfOnn).
#[derive(Debug, Clone, Params)]
pub struct QuadraticSelfOnnFitParams {
    /// Parameters common to all trainings.
    #[param(flatten, epochs = 30, batch_size = 64, lr = 0.01, optimizer = OptimizerKind::Sgd)]
    pub training: TrainingParams,
    /// Training parameters common to all keyword spotting learners.
    #[param(flatten)]
    pub words: WordFitParams,
}

impl TrainableWords for QuadraticSelfOnnKind {
    type FitParams = QuadraticSelfOnnFitParams;
    type Network = QuadraticSelfOnnNetwork;

    fn training(fit_params: &QuadraticSelfOnnFitParams) -> (&TrainingParams, &WordFitParams) {
        (&fit_params.training, &fit_params.words)
    }

    fn network(
        params: &QuadraticSelfOnnParams,
        classes: usize,
        dropout: f64,
        device: &Device,
    ) -> QuadraticSelfOnnNetwork {
        QuadraticSelfOnnNetwork::new(params.expansion_order, classes, dropout, device)
    }

    fn forward(network: &QuadraticSelfOnnNetwork, cepstra: Tensor<3>) -> Tensor<2> {
        network.forward(cepstra)
    }
}
