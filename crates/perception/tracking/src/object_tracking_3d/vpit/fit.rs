//! How it trains.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Error, Result, Statistics};
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{ScheduleKind, TrainingParams, begin, fit_learner, open_for_training};

use super::layout::VpitLayout;
use super::network::VpitNetwork;
use super::objective::VpitObjective;
use super::pairs::Pairs;
use super::{Vpit, VpitParams};

/// How a user may train it: on recordings of point clouds with numbered boxes in space.
#[derive(Debug, Clone, Params)]
pub struct VpitFitParams {
    /// Side of a pillar; a view shows 64 of them each way, the largest object a quarter of it.
    #[param(default = 0.2, range = 0.02..=5.0, unit = "m")]
    pub pillar: f32,
    /// An object is looked for at most so many moments after it was seen.
    #[param(default = 5, range = 1..=1000)]
    pub apart: usize,
    /// At most so many objects of a scan go into a batch.
    #[param(default = 4, range = 1..=1000)]
    pub objects: usize,
    /// Whether objects are looked for from places beside them, and turned.
    #[param(default = true)]
    pub augment: bool,
    /// What every training takes.
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

/// Heights above an object's floor that count, metres.
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
                "VPIT follows one object and does not know which one of a data set: fit takes no val_dataset",
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
            objects: fit_params.objects,
            augment: fit_params.augment,
        };
        let network = network_from_base(VpitNetwork::new(&begin(job, training)?), base)?;
        let pairs = Pairs { dataset: &*dataset, apart: fit_params.apart, seed: training.seed };
        fit_learner::<Self, _>(&objective, network, params, training, &pairs, None, job)
    }
}
