//! Training of CoST-GCN, CoA-GCN and CoS-TR: on clips, as
//! [`SpatioTemporalGcn`](crate::skeleton_based_action_recognition::SpatioTemporalGcn); one time step is exported.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob, Learner};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Error, Result, ResultExt, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{
    Container, Objective, OptimizerKind, TrainingParams, fit_learner, open_for_training, seeded_device,
    training_device,
};

use super::{CoStGcn, CoStGcnParams};
use crate::skeleton_based_action_recognition::model_checks::joints_of;
use crate::skeleton_based_action_recognition::network::ActionNetwork;
use crate::skeleton_based_action_recognition::objective::{ActionObjective, Form};
use crate::skeleton_based_action_recognition::sizes::{Architecture, NetworkSizes};
use crate::skeleton_based_action_recognition::{SpatioTemporalGcn, SpatioTemporalGcnParams};

/// Training parameters of [`CoStGcn`].
#[derive(Debug, Clone, Params)]
pub struct CoStGcnFitParams {
    /// Parameters common to all trainings.
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

impl Fit for CoStGcn {
    type FitParams = CoStGcnFitParams;

    fn fit(
        base: Option<&Model>,
        params: &CoStGcnParams,
        fit_params: &CoStGcnFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let training = &fit_params.training;
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = classes_to_train(&*dataset, params.num_classes, "num_classes")?;
        joints_of(params.graph_type, params.num_point)?;
        let (sizes, device) = (params.sizes(), seeded_device(job, training)?);
        let network = ActionNetwork::new(&sizes, classes.len(), fit_params.dropout, &device)?;
        let network = network_from_base(network, base)?;
        let objective = ActionObjective {
            learner: Self::SPEC.name,
            sizes,
            form: Form::Step,
            params: params.to_map(),
            classes,
            smoothing: fit_params.label_smoothing,
            augment: fit_params.augment,
        };
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}

/// Returns the container of a [`CoStGcn`] with the weights of a [`SpatioTemporalGcn`] that was trained by this crate.
///
/// # Errors
/// `Format` when `model` is of another learner, has no trainable weights, or is not a network of `method_name = stgcn`.
pub fn co_st_gcn_from(model: &Model) -> Result<Container> {
    let context = || format!("converting {} to CoST-GCN", model.path().display());
    model.check_learner(SpatioTemporalGcn::SPEC.name).context(context)?;
    let clip_wise = SpatioTemporalGcnParams::from_map(model.params()).context(context)?;
    let NetworkSizes { architecture, channels, .. } = clip_wise.sizes().context(context)?;
    if architecture != Architecture::StGcn {
        return Err(Error::format(format!(
            "{} has method_name = {}, which has no form for single frames; convert a model of stgcn",
            model.path().display(),
            clip_wise.method_name.name()
        )));
    }
    let clip = clip_wise.clip;
    let params = CoStGcnParams {
        num_classes: clip.num_class,
        num_point: clip.num_point,
        num_person: clip.num_person,
        in_channels: clip.in_channels,
        graph_type: clip.graph_type,
        backbone: super::Backbone::CoStGcn,
        sequence_len: clip.num_frames,
        channels,
        temporal_kernel: clip.temporal_kernel,
    };
    let classes = model.manifest().classes.clone();
    let (sizes, device) = (params.sizes(), training_device(opendr_engine::Device::Cpu)?);
    let network = ActionNetwork::new(&sizes, classes.len(), 0.0, &device)?;
    let network = network_from_base(network, Some(model)).context(context)?;
    let (params, form) = (params.to_map(), Form::Step);
    let learner = CoStGcn::SPEC.name;
    let objective = ActionObjective { learner, sizes, form, params, classes, smoothing: 0.0, augment: false };
    objective.container(&network)
}
