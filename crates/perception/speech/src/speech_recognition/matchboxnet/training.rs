//! Training of MatchboxNet.

use burn::tensor::{Device, Tensor};
use opendr_engine::params::Params;
use opendr_training::{OptimizerKind, TrainingParams};

use super::network::{MatchboxNetNetwork, NetworkSizes};
use super::{MatchboxNetKind, MatchboxNetParams};
use crate::speech_recognition::word_learner::{TrainableWords, WordFitParams};

/// Training parameters of [`MatchboxNet`](super::MatchboxNet).
#[derive(Debug, Clone, Params)]
pub struct MatchboxNetFitParams {
    /// Parameters common to all trainings.
    #[param(flatten, epochs = 30, batch_size = 64, lr = 0.0003, optimizer = OptimizerKind::Adam)]
    pub training: TrainingParams,
    /// Training parameters common to all keyword spotting learners.
    #[param(flatten)]
    pub words: WordFitParams,
}

impl TrainableWords for MatchboxNetKind {
    type FitParams = MatchboxNetFitParams;
    type Network = MatchboxNetNetwork;

    fn training(fit_params: &MatchboxNetFitParams) -> (&TrainingParams, &WordFitParams) {
        (&fit_params.training, &fit_params.words)
    }

    fn network(
        params: &MatchboxNetParams,
        classes: usize,
        dropout: f64,
        device: &Device,
    ) -> MatchboxNetNetwork {
        let sizes = NetworkSizes {
            blocks: params.number_of_blocks,
            subblocks: params.number_of_subblocks,
            channels: params.number_of_channels,
            classes,
            dropout,
        };
        MatchboxNetNetwork::new(&sizes, device)
    }

    fn forward(network: &MatchboxNetNetwork, cepstra: Tensor<3>) -> Tensor<2> {
        network.forward(cepstra)
    }
}
