//! Training of ST-GCN, TA-GCN and ST-BLN.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob, Learner as _};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{
    OptimizerKind, ScheduleKind, TrainingParams, fit_learner, open_for_training, seeded_device,
};

use super::{SpatioTemporalGcn, SpatioTemporalGcnParams};
use crate::skeleton_based_action_recognition::network::ActionNetwork;
use crate::skeleton_based_action_recognition::objective::{ActionObjective, Form};

/// Training parameters of the learners that classify clips of skeletons.
#[derive(Debug, Clone, Params)]
pub struct SpatioTemporalGcnFitParams {
    /// Parameters common to all trainings.
    #[param(
        flatten,
        epochs = 50,
        batch_size = 128,
        lr = 0.1,
        lr_schedule = ScheduleKind::Step,
        lr_steps = vec![30, 40],
        optimizer = OptimizerKind::Sgd,
        weight_decay = 0.0001
    )]
    pub training: TrainingParams,
    /// Dropout probability between layers.
    #[param(default = 0.0, range = 0.0..=0.99)]
    pub dropout: f64,
    /// Label smoothing: weight of the uniform distribution over the classes in the target.
    #[param(default = 0.0, range = 0.0..=0.9)]
    pub label_smoothing: f32,
    /// Whether skeletons are mirrored, rotated, stretched, cut in time and changed in speed at random.
    #[param(default = true)]
    pub augment: bool,
}

impl Fit for SpatioTemporalGcn {
    type FitParams = SpatioTemporalGcnFitParams;

    fn fit(
        base: Option<&Model>,
        params: &SpatioTemporalGcnParams,
        fit_params: &SpatioTemporalGcnFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let training = &fit_params.training;
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = classes_to_train(&*dataset, params.clip.num_class, "num_class")?;
        let sizes = params.sizes()?;
        let params = SpatioTemporalGcnParams { channels: Some(sizes.channels.clone()), ..params.clone() };
        let device = seeded_device(job, training)?;
        let network = ActionNetwork::new(&sizes, classes.len(), fit_params.dropout, &device)?;
        let network = network_from_base(network, base)?;
        let objective = ActionObjective {
            learner: Self::SPEC.name,
            sizes,
            form: Form::Clip,
            params: params.to_map(),
            classes,
            smoothing: fit_params.label_smoothing,
            augment: fit_params.augment,
        };
        fit_learner::<Self, _>(&objective, network, &params, training, &*dataset, val_dataset, job)
    }
}
