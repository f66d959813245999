//! Training of EdgeSpeechNets.

use burn::tensor::{Device, Tensor};
use opendr_engine::params::Params;
use opendr_training::{OptimizerKind, TrainingParams};

use super::network::EdgeSpeechNetsNetwork;
use super::{EdgeSpeechNetsKind, EdgeSpeechNetsParams};
use crate::speech_recognition::word_learner::{TrainableWords, WordFitParams};

/// Training parameters of [`EdgeSpeechNets`](super::EdgeSpeechNets).
#[derive(Debug, Clone, Params)]
pub struct EdgeSpeechNetsFitParams {
    /// Parameters common to all trainings.
    #[param(flatten, epochs = 30, batch_size = 64, lr = 0.01, optimizer = OptimizerKind::Sgd)]
    pub training: TrainingParams,
    /// Training parameters common to all keyword spotting learners.
    #[param(flatten)]
    pub words: WordFitParams,
}

impl TrainableWords for EdgeSpeechNetsKind {
    type FitParams = EdgeSpeechNetsFitParams;
    type Network = EdgeSpeechNetsNetwork;

    fn training(fit_params: &EdgeSpeechNetsFitParams) -> (&TrainingParams, &WordFitParams) {
        (&fit_params.training, &fit_params.words)
    }

    fn network(
        params: &EdgeSpeechNetsParams,
        classes: usize,
        dropout: f64,
        device: &Device,
    ) -> EdgeSpeechNetsNetwork {
        EdgeSpeechNetsNetwork::new(params.architecture, classes, dropout, device)
    }

    fn forward(network: &EdgeSpeechNetsNetwork, cepstra: Tensor<3>) -> Tensor<2> {
        network.forward(cepstra)
    }
}
