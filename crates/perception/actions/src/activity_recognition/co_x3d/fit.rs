//! How it trains: clip by clip, as [`X3d`](crate::activity_recognition::X3d); what is exported is one step.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob, Learner};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, ResultExt, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{
    Container, Objective, OptimizerKind, TrainingParams, begin, fit_learner, open_for_training,
    training_device,
};

use super::{CoX3d, CoX3dParams};
use crate::activity_recognition::network::ActivityNetwork;
use crate::activity_recognition::objective::{ActivityObjective, Form};
use crate::activity_recognition::{X3d, X3dParams};

/// How a user may train it.
#[derive(Debug, Clone, Params)]
pub struct CoX3dFitParams {
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

impl Fit for CoX3d {
    type FitParams = CoX3dFitParams;

    fn fit(
        base: Option<&Model>,
        params: &CoX3dParams,
        fit_params: &CoX3dFitParams,
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
        let (params_map, form) = (params.to_map(), Form::Step);
        let objective =
            ActivityObjective { sizes, form, params: params_map, classes, augment: fit_params.augment };
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}

/// The container of a [`CoX3d`] with the weights of an [`X3d`] that was trained here.
///
/// # Errors
/// `Format` when `model` is another learner's, or holds no weights to go on from.
pub fn co_x3d_from(model: &Model) -> Result<Container> {
    let named = || format!("making a CoX3D of {}", model.path().display());
    model.check_learner(X3d::SPEC.name).context(named)?;
    let clip_wise = X3dParams::from_map(model.params()).context(named)?;
    let params = CoX3dParams {
        backbone: clip_wise.backbone,
        num_classes: clip_wise.num_classes,
        temporal_window_size: clip_wise.num_frames,
        side: clip_wise.side,
        width: clip_wise.width,
        depth: clip_wise.depth,
    };
    let (sizes, classes) = (params.sizes()?, model.manifest().classes.clone());
    let device = training_device(opendr_engine::Device::Cpu)?;
    let network = ActivityNetwork::new(&sizes, classes.len(), 0.0, &device);
    let network = network_from_base(network, Some(model)).context(named)?;
    let (params, form) = (params.to_map(), Form::Step);
    ActivityObjective { sizes, form, params, classes, augment: false }.container(&network)
}
