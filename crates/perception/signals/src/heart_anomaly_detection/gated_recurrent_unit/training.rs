//! Training of the gated recurrent unit.

use burn::tensor::{Device, Tensor};
use opendr_engine::params::Params;
use opendr_training::{OptimizerKind, ScheduleKind, TrainingParams};

use super::network::GatedRecurrentUnitNetwork;
use super::{GatedRecurrentUnitKind, GatedRecurrentUnitParams};
use crate::heart_anomaly_detection::heart_learner::{HeartSizes, TrainableHeart};

/// Training parameters of [`GatedRecurrentUnit`](super::GatedRecurrentUnit).
#[derive(Debug, Clone, Params)]
pub struct GatedRecurrentUnitFitParams {
    /// Parameters common to all trainings.
    #[param(
        flatten,
        epochs = 200,
        batch_size = 32,
        lr = 0.0002,
        lr_schedule = ScheduleKind::Cosine,
        lr_min = 0.00001,
        optimizer = OptimizerKind::Adam
    )]
    pub training: TrainingParams,
    /// Weight of each class in the loss, for imbalanced data; empty for equal weights.
    #[param(range = 1e-6..=1e6)]
    pub class_weight: Vec<f32>,
}

impl TrainableHeart for GatedRecurrentUnitKind {
    type FitParams = GatedRecurrentUnitFitParams;
    type Network = GatedRecurrentUnitNetwork;

    fn training(fit_params: &GatedRecurrentUnitFitParams) -> (&TrainingParams, &[f32]) {
        (&fit_params.training, &fit_params.class_weight)
    }

    fn network(
        params: &GatedRecurrentUnitParams,
        sizes: &HeartSizes,
        device: &Device,
    ) -> GatedRecurrentUnitNetwork {
        GatedRecurrentUnitNetwork::new(sizes, params.recurrent_unit, device)
    }

    fn forward(network: &GatedRecurrentUnitNetwork, series: Tensor<3>) -> Tensor<2> {
        network.forward(series)
    }
}
