//! Training of the keyword spotting learners.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::{Result, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{fit_learner, open_for_training, seeded_device};

use super::WordLearner;
use super::objective::WordObjective;
use super::trainable::{TrainableWords, WordFitParams};

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
