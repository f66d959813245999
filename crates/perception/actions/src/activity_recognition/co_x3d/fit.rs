//! Training of CoX3D: on clips, as [`X3d`]; one time step is exported.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob, Learner};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, ResultExt, Statistics};
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{Container, Objective, training_device};

use super::{CoX3d, CoX3dParams};
use crate::activity_recognition::fit::{ActivityParams, X3dFitParams, fit_activity};
use crate::activity_recognition::network::ActivityNetwork;
use crate::activity_recognition::objective::{ActivityObjective, Form};
use crate::activity_recognition::sizes::Sizes;
use crate::activity_recognition::{X3d, X3dParams};

/// Training parameters of [`CoX3d`]: those of [`X3d`].
pub type CoX3dFitParams = X3dFitParams;

impl ActivityParams for CoX3dParams {
    fn class_count(&self) -> Option<usize> {
        self.num_classes
    }

    fn network_sizes(&self) -> Result<Sizes> {
        self.sizes()
    }
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
        fit_activity::<Self>(base, params, fit_params, Form::Step, dataset, val_dataset, job)
    }
}

/// Returns the container of a [`CoX3d`] with the weights of an [`X3d`] that was trained by this crate.
///
/// # Errors
/// `Format` when `model` is of another learner or has no trainable weights.
pub fn co_x3d_from(model: &Model) -> Result<Container> {
    let context = || format!("converting {} to CoX3D", model.path().display());
    model.check_learner(X3d::SPEC.name).context(context)?;
    let clip_wise = X3dParams::from_map(model.params()).context(context)?;
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
    let network = network_from_base(network, Some(model)).context(context)?;
    let (params, form) = (params.to_map(), Form::Step);
    ActivityObjective { sizes, form, params, classes, augment: false }.container(&network)
}
