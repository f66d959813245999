//! Training of the patch network.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, Statistics, ValueType};
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{OptimizerKind, TrainingParams, fit_learner, open_accepted, seeded_device};

use super::network::PatchNetwork;
use super::objective::Patches;
use super::{HighResolutionPatches, HighResolutionPatchesParams};

/// A category per image, or boxes.
const ANNOTATIONS: [ValueType; 2] = [ValueType::Category, ValueType::BoundingBoxList];

/// Training parameters of [`HighResolutionPatches`]: it trains on patches of two classes, of which class 0 is the background,
/// or on images with boxes around the objects.
#[derive(Debug, Clone, Params)]
pub struct HighResolutionPatchesFitParams {
    /// Parameters common to all trainings.
    #[param(
        flatten,
        epochs = 100,
        batch_size = 512,
        lr = 0.001,
        weight_decay = 0.00001,
        momentum = 0.9,
        num_workers = 4,
        optimizer = OptimizerKind::Adam
    )]
    pub training: TrainingParams,
    /// Maximum number of patches with an object per image with boxes, and of patches without.
    #[param(default = 8, range = 1..=1000)]
    pub patches: usize,
}

impl Fit for HighResolutionPatches {
    type FitParams = HighResolutionPatchesFitParams;

    fn fit(
        base: Option<&Model>,
        params: &HighResolutionPatchesParams,
        fit_params: &HighResolutionPatchesFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let HighResolutionPatchesFitParams { training, patches } = fit_params;
        let dataset = open_accepted::<Self>(&ANNOTATIONS, dataset, job)?;
        let network = PatchNetwork::new(params.architecture, &seeded_device(job, training)?);
        let network = network_from_base(network, base)?;
        let objective = Patches { params, most: *patches };
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}
