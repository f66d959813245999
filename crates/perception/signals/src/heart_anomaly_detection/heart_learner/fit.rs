//! Training of the learners of heart signals.

use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::{Error, Result, Statistics, Value};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{fit_learner, open_for_training, seeded_device};

use super::HeartLearner;
use super::objective::HeartObjective;
use super::trainable::{HeartSizes, TrainableHeart};
use crate::model_checks::check_size;

impl<K: TrainableHeart> Fit for HeartLearner<K> {
    type FitParams = K::FitParams;

    fn fit(
        base: Option<&Model>,
        params: &K::Params,
        fit_params: &K::FitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let (training, class_weight) = K::training(fit_params);
        let heart = K::heart(params);
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = classes_to_train(&*dataset, heart.n_class, "n_class")?;
        let shape = shape_of(&*dataset)?;
        check_size("in_channels", heart.in_channels, shape[1])?;
        check_size("series_length", heart.series_length, shape[0])?;
        let weights = class_weight.len();
        if weights > 0 && weights != classes.len() {
            let count = classes.len();
            return Err(Error::invalid_param(format!(
                "class_weight has {weights} weights for {count} classes; it needs one per class"
            )));
        }
        let sizes = HeartSizes { shape, classes: classes.len(), dropout: heart.dropout };
        let network = K::network(params, &sizes, &seeded_device(job, training)?);
        let network = network_from_base(network, base)?;
        let objective = HeartObjective::<K> { sizes, params, class_weight, classes };
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}

/// Returns `[time, features]` of the first series.
fn shape_of(dataset: &dyn DatasetIterator) -> Result<[usize; 2]> {
    if dataset.is_empty() {
        return Err(Error::invalid_input("the training data set is empty"));
    }
    match dataset.get(0)?.data.first() {
        Some(Value::Timeseries(series)) => Ok(series.shape()),
        _ => Err(Error::invalid_input(
            "the data set has no time series; use a data set of heart signals, e.g. ucr",
        )),
    }
}
