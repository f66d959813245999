//! How it trains.

use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Error, Result, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{OptimizerKind, ScheduleKind, TrainingParams, begin, fit_learner, open_for_training};

use super::network::{BilinearNetwork, NetworkSizes};
use super::objective::{ExpressionObjective, sequence_of};
use super::{KINDS, ProgressiveSpatioTemporalBln, ProgressiveSpatioTemporalBlnParams};

/// How a user may train it.
#[derive(Debug, Clone, Params)]
pub struct ProgressiveSpatioTemporalBlnFitParams {
    /// What every training takes.
    #[param(
        flatten,
        epochs = 400,
        batch_size = 128,
        lr = 0.1,
        lr_schedule = ScheduleKind::Step,
        lr_steps = vec![400],
        optimizer = OptimizerKind::Sgd,
        weight_decay = 0.0001
    )]
    pub training: TrainingParams,
    /// Share of values between layers that are left out at random in each training step.
    #[param(default = 0.2, range = 0.0..=0.99)]
    pub dropout: f64,
}

impl Fit for ProgressiveSpatioTemporalBln {
    type FitParams = ProgressiveSpatioTemporalBlnFitParams;

    fn fit(
        base: Option<&Model>,
        params: &ProgressiveSpatioTemporalBlnParams,
        fit_params: &ProgressiveSpatioTemporalBlnFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let ProgressiveSpatioTemporalBlnFitParams { training, dropout } = fit_params;
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = classes_to_train(&*dataset, params.num_class, "num_class")?;
        let sizes = sizes(params, &*dataset)?;
        let params = ProgressiveSpatioTemporalBlnParams { num_point: Some(sizes.points), ..params.clone() };
        let network = BilinearNetwork::new(&sizes, classes.len(), *dropout, &begin(job, training)?);
        let network = network_from_base(network, base)?;
        let objective = ExpressionObjective { params: &params, classes, sizes };
        fit_learner::<Self, _>(&objective, network, &params, training, &*dataset, val_dataset, job)
    }
}

/// The network's sizes: as many landmarks as the first sample has, where nobody says.
fn sizes(params: &ProgressiveSpatioTemporalBlnParams, dataset: &dyn DatasetIterator) -> Result<NetworkSizes> {
    if dataset.is_empty() {
        return Err(Error::invalid_input("the data set to train on is empty"));
    }
    let there = sequence_of(&dataset.get(0)?)?.shape()[3];
    Ok(NetworkSizes {
        features: KINDS * params.in_channels,
        frames: params.num_frames,
        points: params.num_point.unwrap_or(there),
        channels: params.topology.iter().map(|blocks| blocks * params.blocksize).collect(),
    })
}
