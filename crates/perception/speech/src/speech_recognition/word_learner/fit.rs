//! Training of the keyword spotting learners.

use burn::module::Module;
use burn::tensor::{Device, Tensor};
use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{TrainingParams, fit_learner, open_for_training, seeded_device};

use super::objective::WordObjective;
use super::{WordKind, WordLearner};

/// Training parameters common to all keyword spotting learners.
#[derive(Debug, Clone, Params)]
pub struct WordFitParams {
    /// Dropout probability between layers.
    #[param(default = 0.2, range = 0.0..=0.99)]
    pub dropout: f64,
    /// Whether audio is shifted, changed in volume and mixed with noise, and its cepstra masked in part, at random.
    #[param(default = true)]
    pub augment: bool,
}

/// A network kind that trains.
pub trait TrainableWords: WordKind + Sized {
    /// Training parameters of the learner.
    type FitParams: Params;
    /// Trained network.
    type Network: Module;

    /// Returns the parameters common to all trainings, and those common to the keyword spotting learners.
    fn training(fit_params: &Self::FitParams) -> (&TrainingParams, &WordFitParams);

    /// Returns a network for `classes` with initial weights and the given dropout probability.
    fn network(params: &Self::Params, classes: usize, dropout: f64, device: &Device) -> Self::Network;

    /// Returns logits `[batch, classes]` of cepstra `[batch, coefficients, frames]`.
    fn forward(network: &Self::Network, cepstra: Tensor<3>) -> Tensor<2>;
}

impl<K: TrainableWords> Fit for WordLearner<K> {
    type FitParams = K::FitParams;

    fn fit(
        base: Option<&Model>,
        params: &K::Params,
        fit_params: &K::FitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let (training, WordFitParams { dropout, augment }) = K::training(fit_params);
        let dataset = open_for_training::<Self>(dataset, job)?;
        let requested = K::words(params).output_classes_n;
        let classes = classes_to_train(&*dataset, requested, "output_classes_n")?;
        let network = K::network(params, classes.len(), *dropout, &seeded_device(job, training)?);
        let network = network_from_base(network, base)?;
        let objective = WordObjective::<K> { params, classes, augment: *augment };
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}
