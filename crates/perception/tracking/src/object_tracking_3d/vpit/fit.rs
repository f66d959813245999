//! Training of VPIT.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Error, Result, Statistics};
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{ScheduleKind, TrainingParams, fit_learner, open_for_training, seeded_device};

use super::layout::VpitLayout;
use super::network::VpitNetwork;
use super::objective::VpitObjective;
use super::pairs::Pairs;
use super::{Vpit, VpitParams};

/// Training parameters of [`Vpit`]. Samples are point clouds of recordings with 3D boxes with identities.
#[derive(Debug, Clone, Params)]
pub struct VpitFitParams {
    /// Side of a pillar; a view has 64 pillars along each axis, the largest object a quarter of it.
    #[param(default = 0.2, range = 0.02..=5.0, unit = "m")]
    pub pillar: f32,
    /// Maximum number of steps between the two scans of a pair.
    #[param(default = 5, range = 1..=1000, former = "apart")]
    pub max_frame_gap: usize,
    /// Maximum number of objects per scan in a batch.
    #[param(default = 4, range = 1..=1000, former = "objects")]
    pub max_objects: usize,
    /// Whether views are shifted and rotated at random relative to their objects.
    #[param(default = true)]
    pub augment: bool,
    /// Parameters of every training.
    #[param(
        flatten,
        lr = 0.003,
        epochs = 10,
        batch_size = 8,
        weight_decay = 0.0001,
        grad_clip = 10.0,
        lr_schedule = ScheduleKind::Cosine,
        warmup_steps = 20,
        num_workers = 1
    )]
    pub training: TrainingParams,
}

/// Range of heights above an object's bottom, in metres.
const HEIGHTS: [f32; 2] = [-0.6, 3.4];

impl Fit for Vpit {
    type FitParams = VpitFitParams;

    fn fit(
        base: Option<&Model>,
        params: &VpitParams,
        fit_params: &VpitFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        if val_dataset.is_some() {
            return Err(Error::unsupported(
                "VPIT tracks one object, which a validation does not select; call fit without val_dataset",
            ));
        }
        let training = &fit_params.training;
        let dataset = open_for_training::<Self>(dataset, job)?;
        let layout = match base {
            Some(model) => VpitLayout::from_manifest(model.manifest())?,
            None => VpitLayout { pillar: fit_params.pillar, heights: HEIGHTS, scale: 1.0, bias: 0.0 },
        };
        let objective = VpitObjective {
            layout,
            context: f64::from(params.context_amount),
            objects: fit_params.max_objects,
            augment: fit_params.augment,
        };
        let network = network_from_base(VpitNetwork::new(&seeded_device(job, training)?), base)?;
        let pairs = Pairs { dataset: &*dataset, apart: fit_params.max_frame_gap, seed: training.seed };
        fit_learner::<Self, _>(&objective, network, params, training, &pairs, None, job)
    }
}
