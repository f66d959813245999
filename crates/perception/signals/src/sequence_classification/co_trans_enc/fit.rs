//! Training of the continual transformer encoder, on whole sequences; one step is exported.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Error, Result, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{OptimizerKind, TrainingParams, fit_learner, open_for_training, seeded_device};

use super::network::CoTransEncNetwork;
use super::objective::{SequenceObjective, series_of};
use super::{CoTransEnc, CoTransEncParams};
use crate::model_checks::check_size;

/// Training parameters of [`CoTransEnc`].
#[derive(Debug, Clone, Params)]
pub struct CoTransEncFitParams {
    /// Parameters common to all trainings.
    #[param(
        flatten,
        epochs = 10,
        batch_size = 64,
        lr = 0.01,
        optimizer = OptimizerKind::Sgd,
        weight_decay = 0.0001,
        seed = 123
    )]
    pub training: TrainingParams,
    /// Dropout probability of attention weights and of the outputs of linear maps.
    #[param(default = 0.1, range = 0.0..=0.99)]
    pub dropout: f64,
}

impl Fit for CoTransEnc {
    type FitParams = CoTransEncFitParams;

    fn fit(
        base: Option<&Model>,
        params: &CoTransEncParams,
        fit_params: &CoTransEncFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let training = &fit_params.training;
        let dataset = open_for_training::<Self>(dataset, job)?;
        if dataset.is_empty() {
            return Err(Error::invalid_input("the training data set is empty"));
        }
        let classes = classes_to_train(&*dataset, params.num_classes, "num_classes")?;
        let [_, inputs] = series_of(&dataset.get(0)?)?.shape();
        check_size("input_dims", params.input_dims, inputs)?;
        let device = seeded_device(job, training)?;
        let network = CoTransEncNetwork::new(params, inputs, classes.len(), fit_params.dropout, &device)?;
        let network = network_from_base(network, base)?;
        let objective = SequenceObjective { params, inputs, classes };
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}
