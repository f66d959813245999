//! How it trains.

use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Error, Result, Statistics, Value};
use opendr_training::{OptimizerKind, ScheduleKind, TrainingParams, begin, fit_learner, open_for_training};

use super::network::{GatedRecurrentUnitNetwork, NetworkSizes};
use super::objective::HeartObjective;
use super::{GatedRecurrentUnit, GatedRecurrentUnitParams, must_be};
use crate::labelled::classes_to_train;
use crate::trainable_weights::network_from_base;

/// How a user may train it.
#[derive(Debug, Clone, Params)]
pub struct GatedRecurrentUnitFitParams {
    /// What every training takes.
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
    /// How much each class weighs in the loss, for data where some are rare; empty: all alike.
    #[param(range = 1e-6..=1e6)]
    pub class_weight: Vec<f32>,
}

impl Fit for GatedRecurrentUnit {
    type FitParams = GatedRecurrentUnitFitParams;

    fn fit(
        base: Option<&Model>,
        params: &GatedRecurrentUnitParams,
        fit_params: &GatedRecurrentUnitFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let training = &fit_params.training;
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = classes_to_train(&*dataset, params.n_class, "n_class")?;
        let [time, features] = shape_of(&*dataset)?;
        must_be("in_channels", params.in_channels, features)?;
        must_be("series_length", params.series_length, time)?;
        let weights = fit_params.class_weight.len();
        if weights > 0 && weights != classes.len() {
            let count = classes.len();
            return Err(Error::invalid_param(format!(
                "class_weight has {weights} weights for {count} classes; give one a class"
            )));
        }
        let GatedRecurrentUnitParams { recurrent_unit: hidden, dropout, .. } = *params;
        let sizes = NetworkSizes { features, time, classes: classes.len(), hidden, dropout };
        let network = GatedRecurrentUnitNetwork::new(&sizes, &begin(job, training)?);
        let network = network_from_base(network, base)?;
        let objective = HeartObjective { sizes, params, class_weight: &fit_params.class_weight, classes };
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}

/// `[time, features]` of the first series.
fn shape_of(dataset: &dyn DatasetIterator) -> Result<[usize; 2]> {
    if dataset.is_empty() {
        return Err(Error::invalid_input("the data set to train on is empty"));
    }
    match dataset.get(0)?.data.first() {
        Some(Value::Timeseries(series)) => Ok(series.shape()),
        _ => {
            Err(Error::invalid_input("the data set has no time series; give one of heart signals, e.g. ucr"))
        }
    }
}
