//! Training of PST-BLN.

use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Error, Result, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{
    OptimizerKind, ScheduleKind, TrainingParams, fit_learner, open_for_training, seeded_device,
};

use super::network::{BilinearNetwork, NetworkSizes};
use super::objective::{ExpressionObjective, sequence_of};
use super::{KINDS, ProgressiveSpatioTemporalBln, ProgressiveSpatioTemporalBlnParams};

/// Training parameters of [`ProgressiveSpatioTemporalBln`].
#[derive(Debug, Clone, Params)]
pub struct ProgressiveSpatioTemporalBlnFitParams {
    /// Parameters of every training.
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
    /// Dropout probability between layers.
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
        let network = BilinearNetwork::new(&sizes, classes.len(), *dropout, &seeded_device(job, training)?);
        let network = network_from_base(network, base)?;
        let objective = ExpressionObjective { params: &params, classes, sizes };
        fit_learner::<Self, _>(&objective, network, &params, training, &*dataset, val_dataset, job)
    }
}

/// Returns the network's sizes; the number of landmarks defaults to that of the first sample.
fn sizes(params: &ProgressiveSpatioTemporalBlnParams, dataset: &dyn DatasetIterator) -> Result<NetworkSizes> {
    if dataset.is_empty() {
        return Err(Error::invalid_input("the data set is empty; give one with samples"));
    }
    let there = sequence_of(&dataset.get(0)?)?.shape()[3];
    Ok(NetworkSizes {
        features: KINDS * params.in_channels,
        frames: params.num_frames,
        points: params.num_point.unwrap_or(there),
        channels: params.topology.iter().map(|blocks| blocks * params.blocksize).collect(),
    })
}
