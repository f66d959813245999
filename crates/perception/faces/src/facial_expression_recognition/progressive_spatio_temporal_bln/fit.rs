//! Training of PST-BLN.

use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Error, Result, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::progressive::{Stage, train_topology};
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
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = classes_to_train(&*dataset, params.num_class, "num_class")?;
        let points = points(params, &*dataset)?;
        let mut train = |stage: &Stage<'_>| {
            let device = seeded_device(stage.job, stage.training)?;
            let network = |topology: &[usize]| {
                let params = params.sized(points, topology);
                let sizes = sizes(&params, points);
                (BilinearNetwork::new(&sizes, classes.len(), fit_params.dropout, &device), sizes, params)
            };
            let (initial, sizes, params) = network(stage.topology);
            let initial = stage.network(initial, |topology| Ok(network(topology).0))?;
            let objective = ExpressionObjective { params: &params, classes: classes.clone(), sizes };
            fit_learner::<Self, _>(
                &objective,
                initial,
                &params,
                stage.training,
                &*dataset,
                val_dataset,
                stage.job,
            )
        };
        train_topology(&params.growth, &fit_params.training, base, job, &mut train)
    }
}

impl ProgressiveSpatioTemporalBlnParams {
    /// Returns the parameters of a network of a number of landmarks and a topology.
    fn sized(&self, points: usize, topology: &[usize]) -> Self {
        Self { num_point: Some(points), growth: self.growth.with_topology(topology), ..self.clone() }
    }
}

/// Returns the number of landmarks; it defaults to that of the first sample.
fn points(params: &ProgressiveSpatioTemporalBlnParams, dataset: &dyn DatasetIterator) -> Result<usize> {
    if dataset.is_empty() {
        return Err(Error::invalid_input("the data set is empty; give one with samples"));
    }
    let there = sequence_of(&dataset.get(0)?)?.shape()[3];
    Ok(params.num_point.unwrap_or(there))
}

/// Returns the network's sizes.
fn sizes(params: &ProgressiveSpatioTemporalBlnParams, points: usize) -> NetworkSizes {
    NetworkSizes {
        features: KINDS * params.in_channels,
        frames: params.num_frames,
        points,
        channels: params.growth.channels(),
    }
}
