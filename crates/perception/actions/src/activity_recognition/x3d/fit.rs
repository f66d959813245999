//! How it trains.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{OptimizerKind, TrainingParams, begin, fit_learner, open_for_training};

use super::{X3d, X3dParams};
use crate::activity_recognition::network::ActivityNetwork;
use crate::activity_recognition::objective::{ActivityObjective, Form};

/// How a user may train it.
#[derive(Debug, Clone, Params)]
pub struct X3dFitParams {
    /// What every training takes.
    #[param(
        flatten,
        epochs = 10,
        batch_size = 64,
        lr = 0.001,
        optimizer = OptimizerKind::Adam,
        weight_decay = 0.00001,
        seed = 123
    )]
    pub training: TrainingParams,
    /// Share of values before the last layer that are left out at random in each training step.
    #[param(default = 0.5, range = 0.0..=0.99)]
    pub dropout: f64,
    /// Whether clips are mirrored at random.
    #[param(default = true)]
    pub augment: bool,
}

impl Fit for X3d {
    type FitParams = X3dFitParams;

    fn fit(
        base: Option<&Model>,
        params: &X3dParams,
        fit_params: &X3dFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let training = &fit_params.training;
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = classes_to_train(&*dataset, params.num_classes, "num_classes")?;
        let sizes = params.sizes()?;
        let device = begin(job, training)?;
        let network = ActivityNetwork::new(&sizes, classes.len(), fit_params.dropout, &device);
        let network = network_from_base(network, base)?;
        let (params_map, form) = (params.to_map(), Form::Clip);
        let objective =
            ActivityObjective { sizes, form, params: params_map, classes, augment: fit_params.augment };
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}
