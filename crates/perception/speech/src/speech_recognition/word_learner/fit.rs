//! How learners of words train.

use burn::module::Module;
use burn::tensor::{Device, Tensor};
use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{TrainingParams, begin, fit_learner, open_for_training};

use super::objective::WordObjective;
use super::{WordKind, WordLearner};

/// What a user may set of the training of every learner of words.
#[derive(Debug, Clone, Params)]
pub struct WordFitParams {
    /// Share of values between layers that are left out at random in each training step.
    #[param(default = 0.2, range = 0.0..=0.99)]
    pub dropout: f64,
    /// Whether training sound is shifted, made louder or softer and mixed with noise, and its cepstra covered in part, all
    /// at random.
    #[param(default = true)]
    pub augment: bool,
}

/// A kind of network that is trained.
pub trait TrainableWords: WordKind + Sized {
    /// What a user may set of its training.
    type FitParams: Params;
    /// The network as it is trained.
    type Network: Module;

    /// What all trainings have, and what those of words have.
    fn training(fit_params: &Self::FitParams) -> (&TrainingParams, &WordFitParams);

    /// A network for `classes`, with weights as training begins with and `dropout`.
    fn network(params: &Self::Params, classes: usize, dropout: f64, device: &Device) -> Self::Network;

    /// Logits `[batch, classes]` of cepstra `[batch, coefficients, frames]`.
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
        let wanted = K::words(params).output_classes_n;
        let classes = classes_to_train(&*dataset, wanted, "output_classes_n")?;
        let network = K::network(params, classes.len(), *dropout, &begin(job, training)?);
        let network = network_from_base(network, base)?;
        let objective = WordObjective::<K> { params, classes, augment: *augment };
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}
