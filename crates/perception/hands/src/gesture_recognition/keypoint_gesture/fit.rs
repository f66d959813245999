//! Training of the gesture classifier.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Error, Result, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{
    OptimizerKind, ScheduleKind, TrainingParams, fit_learner, open_for_training, seeded_device,
};

use super::network::{KeypointGestureNetwork, NetworkSizes};
use super::objective::{GestureObjective, row_of};
use super::{KeypointGesture, KeypointGestureParams};

/// Training parameters of [`KeypointGesture`].
#[derive(Debug, Clone, Params)]
pub struct KeypointGestureFitParams {
    /// Parameters of every training.
    #[param(
        flatten,
        epochs = 40,
        batch_size = 64,
        lr = 0.003,
        lr_schedule = ScheduleKind::Cosine,
        lr_min = 0.00003,
        optimizer = OptimizerKind::Adam
    )]
    pub training: TrainingParams,
}

impl Fit for KeypointGesture {
    type FitParams = KeypointGestureFitParams;

    fn fit(
        base: Option<&Model>,
        params: &KeypointGestureParams,
        fit_params: &KeypointGestureFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let training = &fit_params.training;
        let dataset = open_for_training::<Self>(dataset, job)?;
        if dataset.is_empty() {
            return Err(Error::invalid_input("the data set is empty; give one with samples"));
        }
        let classes = classes_to_train(&*dataset, None, "classes")?;
        let numbers = row_of(&dataset.get(0)?)?.len();
        let KeypointGestureParams { hidden, dropout } = *params;
        let sizes = NetworkSizes { numbers, classes: classes.len(), hidden, dropout };
        let network = KeypointGestureNetwork::new(&sizes, &seeded_device(job, training)?);
        let network = network_from_base(network, base)?;
        let objective = GestureObjective { sizes, params, classes };
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}
