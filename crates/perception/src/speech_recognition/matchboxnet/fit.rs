//! How it trains.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, Statistics};
use opendr_training::{OptimizerKind, TrainingParams, begin, fit_learner, open_for_training};

use super::network::{MatchboxNetNetwork, NetworkSizes};
use super::objective::SpeechObjective;
use super::{MatchboxNet, MatchboxNetParams};
use crate::labelled::classes_to_train;
use crate::trainable_weights::network_from_base;

/// How a user may train it.
#[derive(Debug, Clone, Params)]
pub struct MatchboxNetFitParams {
    /// What every training takes.
    #[param(flatten, epochs = 30, batch_size = 64, lr = 0.0003, optimizer = OptimizerKind::Adam)]
    pub training: TrainingParams,
    /// Share of values between layers that are left out at random in each training step.
    #[param(default = 0.2, range = 0.0..=0.99)]
    pub dropout: f64,
    /// Whether training sound is shifted, made louder or softer and mixed with noise, and its cepstra covered in part, all
    /// at random.
    #[param(default = true)]
    pub augment: bool,
}

impl Fit for MatchboxNet {
    type FitParams = MatchboxNetFitParams;

    fn fit(
        base: Option<&Model>,
        params: &MatchboxNetParams,
        fit_params: &MatchboxNetFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let training = &fit_params.training;
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = classes_to_train(&*dataset, params.output_classes_n, "output_classes_n")?;
        let sizes = NetworkSizes {
            blocks: params.number_of_blocks,
            subblocks: params.number_of_subblocks,
            channels: params.number_of_channels,
            classes: classes.len(),
            dropout: fit_params.dropout,
        };
        let network = MatchboxNetNetwork::new(&sizes, &begin(job, training)?);
        let network = network_from_base(network, base)?;
        let objective = SpeechObjective { params, classes, augment: fit_params.augment };
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}
