//! Training of the attention-based neural bag of features.

use burn::tensor::{Device, Tensor};
use opendr_engine::params::Params;
use opendr_training::{OptimizerKind, ScheduleKind, TrainingParams};

use super::network::AttentionNeuralBagOfFeatureNetwork;
use super::{AttentionNeuralBagOfFeatureKind, AttentionNeuralBagOfFeatureParams};
use crate::heart_anomaly_detection::heart_learner::{HeartSizes, TrainableHeart};

/// Training parameters of [`AttentionNeuralBagOfFeature`](super::AttentionNeuralBagOfFeature).
#[derive(Debug, Clone, Params)]
pub struct AttentionNeuralBagOfFeatureFitParams {
    /// Parameters common to all trainings.
    #[param(
        flatten,
        epochs = 300,
        batch_size = 32,
        lr = 0.001,
        lr_schedule = ScheduleKind::Cosine,
        lr_min = 0.00001,
        optimizer = OptimizerKind::Adam
    )]
    pub training: TrainingParams,
    /// Weight of each class in the loss, for imbalanced data; empty for equal weights.
    #[param(range = 1e-6..=1e6)]
    pub class_weight: Vec<f32>,
}

impl TrainableHeart for AttentionNeuralBagOfFeatureKind {
    type FitParams = AttentionNeuralBagOfFeatureFitParams;
    type Network = AttentionNeuralBagOfFeatureNetwork;

    fn training(fit_params: &AttentionNeuralBagOfFeatureFitParams) -> (&TrainingParams, &[f32]) {
        (&fit_params.training, &fit_params.class_weight)
    }

    fn network(
        params: &AttentionNeuralBagOfFeatureParams,
        sizes: &HeartSizes,
        device: &Device,
    ) -> AttentionNeuralBagOfFeatureNetwork {
        AttentionNeuralBagOfFeatureNetwork::new(params, sizes, device)
    }

    fn forward(network: &AttentionNeuralBagOfFeatureNetwork, series: Tensor<3>) -> Tensor<2> {
        network.forward(series)
    }
}
