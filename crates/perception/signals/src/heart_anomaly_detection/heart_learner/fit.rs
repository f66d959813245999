//! How learners of heart signals train.

use burn::module::Module;
use burn::tensor::{Device, Tensor};
use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Error, Result, Statistics, Value};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{TrainingParams, begin, fit_learner, open_for_training};

use super::objective::HeartObjective;
use super::{HeartKind, HeartLearner, must_be};

/// Sizes that all networks of heart signals have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeartSizes {
    /// Instants and features of a series.
    pub shape: [usize; 2],
    /// Classes.
    pub classes: usize,
    /// Share of features that are left out in training.
    pub dropout: f64,
}

/// A kind of network that is trained.
pub trait TrainableHeart: HeartKind + Sized {
    /// What a user may set of its training.
    type FitParams: Params;
    /// The network as it is trained.
    type Network: Module;

    /// What all trainings have, and how much each class weighs (empty: all alike).
    fn training(fit_params: &Self::FitParams) -> (&TrainingParams, &[f32]);

    /// A network with weights as training begins with.
    fn network(params: &Self::Params, sizes: &HeartSizes, device: &Device) -> Self::Network;

    /// Logits `[batch, classes]` of series `[batch, time, features]`.
    fn forward(network: &Self::Network, series: Tensor<3>) -> Tensor<2>;
}

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
        must_be("in_channels", heart.in_channels, shape[1])?;
        must_be("series_length", heart.series_length, shape[0])?;
        let weights = class_weight.len();
        if weights > 0 && weights != classes.len() {
            let count = classes.len();
            return Err(Error::invalid_param(format!(
                "class_weight has {weights} weights for {count} classes; give one a class"
            )));
        }
        let sizes = HeartSizes { shape, classes: classes.len(), dropout: heart.dropout };
        let network = K::network(params, &sizes, &begin(job, training)?);
        let network = network_from_base(network, base)?;
        let objective = HeartObjective::<K> { sizes, params, class_weight, classes };
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
